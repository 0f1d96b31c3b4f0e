// The dotted path of a parameter, or of a group of them, as --set, [animation] and messages write it:
// "camera.position", "layer.stars.look.noise.0.cull". Everything that builds such a path, takes one apart or
// asks where one lies goes through here; so does the nearest of the known names, where one is misspelt.
#pragma once

#include <fmt/format.h>

#include <compare>
#include <map>

#include "core/standard.h"

namespace astrosplat {

/// A path of parts between dots; empty for the scene itself. Any text is a key, whether or not a parameter
/// has it.
class ParameterKey {
  public:
    ParameterKey() = default;
    ParameterKey(std::string text) : text_(std::move(text)) {}
    ParameterKey(std::string_view text) : text_(text) {}
    ParameterKey(const char* text) : text_(text) {}

    const std::string& text() const { return text_; }
    operator const std::string&() const { return text_; }
    operator std::string_view() const { return text_; }
    bool empty() const { return text_.empty(); }
    std::vector<std::string> parts() const;

    /// The key `path` below this one; an index is a place in a list, from 0.
    ParameterKey operator/(std::string_view path) const;
    ParameterKey operator/(std::size_t index) const { return *this / std::to_string(index); }

    bool is_below(std::string_view group) const;
    /// The rest behind `group`, which this key is below: "noise.0.cull" of "look.noise.0.cull" below "look".
    std::string_view below(std::string_view group) const;
    /// The same key below another group.
    ParameterKey moved(std::string_view from, const ParameterKey& to) const { return to / below(from); }
    /// The group this lies in; empty at the top.
    ParameterKey parent() const;

    /// NAME of "layer.NAME" and all below it; "" where the key is of no layer.
    std::string layer() const;
    /// The same in every layer and list, as in the manual: "layer.look.noise.cull".
    ParameterKey generic() const;

    friend bool operator==(const ParameterKey&, const ParameterKey&) = default;
    friend auto operator<=>(const ParameterKey&, const ParameterKey&) = default;

    template <class Stream>  // std::ostream, without its header
    friend Stream& operator<<(Stream& stream, const ParameterKey& key) {
        stream << key.text_;
        return stream;
    }

  private:
    std::string text_;
};

/// "layer.NAME", which all keys of that layer are below.
ParameterKey layer_key(std::string_view name);

/// Whether a part of a key is a place in a list: digits only.
bool is_list_index(std::string_view part);

/// Where keys were last set: "scene.toml:12", "--set".
using Places = std::map<ParameterKey, std::string>;
/// That of a key; `otherwise` where it was not set.
std::string place_of(const Places& places, const ParameterKey& key, const std::string& otherwise);

/// Number of insertions, deletions, substitutions and swaps of neighbours that turn a into b.
int edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `name`, or "" when none is near. Dotted keys may also match by their last part,
/// so that a right key in the wrong section is found.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

/// "; did you mean 'NAME'?" or "".
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

}  // namespace astrosplat

template <>
struct fmt::formatter<astrosplat::ParameterKey> : fmt::formatter<fmt::string_view> {
    template <class Context>
    auto format(const astrosplat::ParameterKey& key, Context& context) const {
        return fmt::formatter<fmt::string_view>::format(key.text(), context);
    }
};
