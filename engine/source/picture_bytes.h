// Facts of a picture file that OpenImageIO does not give. Its maker, from the XMP packet inside it (AVM, the
// metadata of astronomy outreach, keeps the credit in photoshop:Credit; OpenImageIO cuts it to IPTC's 32
// characters). Whether a JPEG file is whole: libjpeg fills the missing part of a cut file with grey and says
// nothing.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace astrosplat {

/// The value of an XMP property ("photoshop:Credit"), written as an attribute or as an element, with entities
/// decoded, markup dropped and blanks made single. Empty when it is not there.
std::string xmp_property(std::string_view packet, std::string_view name);

/// photoshop:Credit, else dc:creator, else dc:rights, of the XMP packet in the first 4 MiB of a file; may be
/// empty.
std::string xmp_credit(const std::filesystem::path& file);

/// Follows the markers of a JPEG file (ITU-T T.81, B.1.1) to its end-of-image marker; false where the file
/// ends first. Files of other formats are not judged: true.
bool jpeg_is_whole(const std::filesystem::path& file);

}  // namespace astrosplat
