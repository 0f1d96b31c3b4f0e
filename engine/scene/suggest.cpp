// Nearest names by optimal string alignment distance.
#include "scene/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace astrosplat {

int edit_distance(std::string_view a, std::string_view b) {
    std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = static_cast<int>(i);
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
    const int limit = std::max(2, static_cast<int>(last.size()) / 3);
    std::pair<int, int> best{limit + 1, 0};
    std::string nearest;
    for (const std::string& candidate : known) {
        const int whole = edit_distance(name, candidate);
        // One more for the wrong section; and a short last part must match well, or every name would be near.
        const int part = edit_distance(last, last_part(candidate));
        const bool part_counts = part == 0 || part * 3 <= static_cast<int>(last.size());
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
