// Keys are kept as text: they are shown far more often than they are taken apart.
#include "scene/parameter_key.h"

namespace astrosplat {
namespace {

constexpr std::string_view layers_group = "layer";

/// The first part of `path`, which is cut off it.
std::string_view take_part(std::string_view& path) {
    const std::size_t dot = path.find('.');
    const std::string_view part = path.substr(0, dot);
    path.remove_prefix(dot == std::string_view::npos ? path.size() : dot + 1);
    return part;
}

}  // namespace

std::vector<std::string> ParameterKey::parts() const {
    std::vector<std::string> parts;
    for (std::string_view rest = text_; !rest.empty();) parts.emplace_back(take_part(rest));
    return parts;
}

ParameterKey ParameterKey::operator/(std::string_view path) const {
    if (text_.empty()) return path;
    std::string text;
    text.reserve(text_.size() + 1 + path.size());
    text.append(text_).append(1, '.').append(path);
    return text;
}

bool ParameterKey::is_below(std::string_view group) const {
    if (group.empty()) return !text_.empty();
    return text_.size() > group.size() && text_[group.size()] == '.' && text_.starts_with(group);
}

std::string_view ParameterKey::below(std::string_view group) const {
    assert(is_below(group));
    return std::string_view(text_).substr(group.empty() ? 0 : group.size() + 1);
}

ParameterKey ParameterKey::parent() const {
    const std::size_t dot = text_.rfind('.');
    return dot == std::string::npos ? std::string() : text_.substr(0, dot);
}

std::string ParameterKey::layer() const {
    if (!is_below(layers_group)) return "";
    std::string_view rest = below(layers_group);
    return std::string(take_part(rest));
}

ParameterKey ParameterKey::generic() const {
    std::string text;
    text.reserve(text_.size());
    std::string_view rest = text_;
    for (std::size_t i = 0; !rest.empty(); ++i) {
        const std::string_view part = take_part(rest);
        const bool layer_name = i == 1 && text == layers_group;
        if (layer_name || is_list_index(part)) continue;
        text.append(text.empty() ? "" : ".").append(part);
    }
    return text;
}

ParameterKey layer_key(std::string_view name) { return ParameterKey(layers_group) / name; }

bool is_list_index(std::string_view part) {
    return !part.empty() && std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
}

std::string place_of(const Places& places, const ParameterKey& key, const std::string& otherwise) {
    const auto found = places.find(key);
    return found == places.end() ? otherwise : found->second;
}

int edit_distance(std::string_view a, std::string_view b) {
    std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = int(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = int(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int substituted = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, substituted});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

static std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    const std::string_view last = last_part(name);
    const int limit = std::max(2, int(last.size()) / 3);
    std::pair<int, int> best{limit + 1, 0};
    std::string nearest;
    for (const std::string& candidate : known) {
        const int whole = edit_distance(name, candidate);
        // One more for the wrong section; and a short last part must match well, or every name would be near.
        const int part = edit_distance(last, last_part(candidate));
        const bool part_counts = part == 0 || part * 3 <= int(last.size());
        const std::pair<int, int> cost{part_counts ? std::min(whole, part + 1) : whole, whole};
        if (cost < best) {
            best = cost;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> known) {
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace astrosplat
