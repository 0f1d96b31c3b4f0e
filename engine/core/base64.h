// Bytes as text of 64 letters (RFC 4648), as data: addresses hold them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace astrosplat {

std::string base64(std::string_view bytes);

/// The bytes of such a text, with or without the padding at its end; nothing where it is none.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace astrosplat
