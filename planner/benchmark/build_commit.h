#pragma once

namespace corridor {

/// Returns the commit that this program was built from: "1a2b3c4d5e6f", followed by "-dirty" if
/// files of the commit had been changed. Returns "unknown" if the program was not built from a
/// clone.
const char* buildCommit();

}  // namespace corridor
