// What a frame hash was made of, as the frame's file carries it: the canonical text of frame_hash.h, deflated
// and in letters. In: that text, of a frame and of a scene. Out: the packed line, and which keys differ.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

/// Lines "key = value" as one line of printable letters.
std::string pack_hashed_text(const std::string& text);
/// The text again; nothing where it is no such line, or one of more than 64 MiB.
std::optional<std::string> unpack_hashed_text(const std::string& packed);

/// The value behind "KEY =" without blanks around it; nothing where no line has the key.
std::optional<std::string> hashed_value(const std::string& text, const std::string& key);

/// A key with other values in two texts. A value is empty where that text does not have the key: what does
/// not reach the pixels is not hashed. Of keys with several lines the values are joined with "; ".
struct KeyDifference {
    std::string key, first, second;
    bool operator==(const KeyDifference&) const = default;
};
/// In the order of the first text, then of the second.
std::vector<KeyDifference> differing_keys(const std::string& first, const std::string& second);

}  // namespace astrosplat
