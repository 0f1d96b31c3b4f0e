// Whom a picture file names as its maker, from the XMP packet inside it (AVM, the metadata of astronomy
// outreach, keeps the credit in photoshop:Credit). OpenImageIO's answer is cut to IPTC's 32 characters.
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

}  // namespace astrosplat
