#pragma once

namespace corridor {

/// What was built: "1a2b3c4", with "-dirty" where files had been changed; "unknown" where it wasn't
/// built from a clone.
const char* buildCommit();

}  // namespace corridor
