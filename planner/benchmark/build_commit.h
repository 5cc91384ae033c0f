#pragma once

namespace corridor {

/// Returns the commit that this program was built from: "1a2b3c4d5e6f", with "-dirty" if files had
/// been changed; "unknown" if it was not built from a clone.
const char* buildCommit();

}  // namespace corridor
