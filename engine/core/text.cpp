// Locale-free numbers by <charconv>, and the nearest name for "did you mean".
#include "core/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

namespace astrosplat {
namespace {

template <class T>
std::optional<T> parse(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

template <class T>
std::string print_shortest(T value) {
    std::array<char, 40> text;
    const std::to_chars_result result = std::to_chars(text.data(), text.data() + text.size(), value);
    return std::string(text.data(), result.ptr);
}

// The last `parts` dotted parts of a name.
std::string_view last_parts(std::string_view name, std::ptrdiff_t parts) {
    std::size_t at = name.size();
    while (parts-- > 0 && at != std::string_view::npos && at > 0) at = name.rfind('.', at - 1);
    return at == std::string_view::npos ? name : name.substr(std::min(at + 1, name.size()));
}

}  // namespace

std::string_view trim(std::string_view text) {
    const char* blanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> parse_double(std::string_view text) { return parse<double>(text); }
std::optional<std::int64_t> parse_int64(std::string_view text) { return parse<std::int64_t>(text); }

std::string shortest(double value) { return print_shortest(value); }
std::string shortest(float value) { return print_shortest(value); }

int edit_distance(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i) + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    const std::ptrdiff_t parts = std::count(name.begin(), name.end(), '.') + 1;
    int best = static_cast<int>(name.size()) / 3 + 1;
    std::string nearest;
    for (const std::string& candidate : candidates) {
        const int distance =
            std::min(edit_distance(name, candidate), edit_distance(name, last_parts(candidate, parts)));
        if (distance > best || (distance == best && !nearest.empty())) continue;
        best = distance;
        nearest = candidate;
    }
    return nearest;
}

}  // namespace astrosplat
