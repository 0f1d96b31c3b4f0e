// Numbers, names and bytes as text, the same in every locale, and foreign text made fit for messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace astrosplat {

/// `text` without spaces, tabs and line ends at both ends.
std::string_view trim(std::string_view text);

/// `text` fit for a terminal and for one line: control characters, which file names may hold,
/// as "\\n", "\\x1b".
std::string printable(std::string_view text);

/// "1 frame", "12 frames", of a noun that takes an s.
std::string counted(std::int64_t count, std::string_view noun);

/// The texts that are not empty, each once, joined with "; ".
std::string joined_once(const std::vector<std::string>& texts);

/// "over, add or screen".
std::string alternatives(const std::vector<std::string>& names);

/// With a to z for A to Z; other letters stay as they are.
std::string lower_case(std::string text);

/// The whole of `text` as a number, with '.' as the decimal point; a leading '+' is allowed. Empty for
/// anything else, and for values too large for a double. "inf" and "nan" are numbers here: callers that need
/// finite ones check.
std::optional<double> parse_double(std::string_view text);
std::optional<std::int64_t> parse_int64(std::string_view text);

/// The shortest decimal that reads back as the same bits.
std::string shortest(double value);
std::string shortest(float value);

/// A word of a file for a message: in quotes, control characters written out, cut after 40 bytes.
std::string shown(std::string_view word);

/// Bytes as text of 64 letters (RFC 4648).
std::string base64(std::string_view bytes);

/// The bytes of such a text, with or without the padding at its end; nothing where it is none.
std::optional<std::string> bytes_of_base64(std::string_view text);

}  // namespace astrosplat
