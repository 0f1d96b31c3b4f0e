// Whether a JPEG file is whole: libjpeg fills what is missing of a cut file with grey and says nothing.
#pragma once

#include <filesystem>

namespace astrosplat {

/// Follows the markers of a JPEG file (ITU-T T.81, B.1.1) to its end-of-image marker; false where the file
/// ends first. Files of other formats are not judged: true.
bool jpeg_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat
