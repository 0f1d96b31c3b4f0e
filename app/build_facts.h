// The text of --version: which program this is, of which commit, and with what it was built and runs. Out:
// text.
#pragma once

#include <string>

namespace astrosplat {

/// Of the sources, 12 hexadecimal digits, with "-dirty" where files had changed; "unknown" outside a
/// repository.
extern const char* const built_commit;

/// "astrosplat VERSION" on the first line; then one fact a line: "commit ...", "built with ..." (compiler,
/// kind of build), "libraries ..." (name and version of each, as they were at the build) and "instructions
/// ..." (the set in use on this machine).
std::string version_text();

}  // namespace astrosplat
