// Where results go: asked before any work is done, so that hours are not spent on a frame nobody can write.
#pragma once

#include <filesystem>

#include "core/atomic_file.h"

namespace astrosplat {

/// Creates `folder` where it is missing and tries a temporary file in it. Throws OutputError.
void prove_writable(const std::filesystem::path& folder);

/// Folder of a file as an absolute path.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// For files that appear while we work.
inline Existing existing_of(bool overwrite) { return overwrite ? Existing::replace : Existing::keep; }

/// Throws InputError when something lies at `file`, unless `overwrite`.
void refuse_to_overwrite(const std::filesystem::path& file, bool overwrite);

}  // namespace astrosplat
