// Numbers with as many figures as they need, choices and files by their names.
#include "gui/panel/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "edit/command_lines.h"

namespace astrosplat::panel {
namespace {

// 2000000 -> "2 000 000"
std::string grouped(std::string digits) {
    const std::size_t first = digits.rfind('-', 0) == 0 ? 1 : 0;
    if (digits.size() - first < 5) return digits;
    for (std::size_t at = digits.size(); at > first + 3;) {
        at -= 3;
        digits.insert(at, " ");
    }
    return digits;
}

std::size_t places(const std::string& number) {
    const std::size_t point = number.find('.');
    return point == std::string::npos ? 0 : number.size() - point - 1;
}

std::string file_name(const std::string& text) {
    const std::filesystem::path path(text);
    return path.has_filename() ? path.filename().string() : text;
}

}  // namespace

std::string figures(double number) {
    const double size = std::fabs(number);
    if (size >= 1e15 || (size > 0.0 && size < 1e-6)) return short_number(number);
    const int magnitude = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
    const std::string whole = short_number(number);
    const bool exponent = whole.find('e') != std::string::npos;
    const int wanted = std::clamp(2 - magnitude, 0, 6);
    const int own = exponent ? 6 : static_cast<int>(std::min<std::size_t>(places(whole), 6));
    const int most = std::min(wanted + 2, 6);  // five figures: more of an interpolated value only flicker
    const std::string text = fmt::format("{:.{}f}", number, std::clamp(own, wanted, most));
    return places(text) == 0 ? grouped(text) : text;
}

std::string figures(std::int64_t number) { return grouped(fmt::format("{}", number)); }

std::string figures_that_fit(double number, const std::function<bool(const std::string&)>& fits) {
    std::string shortest = figures(number);
    for (int count = 4; count >= 1 && !fits(shortest); --count) {
        std::string fewer = fmt::format("{:.{}g}", number, count);
        if (fewer.find('e') == std::string::npos && fewer.size() < shortest.size())
            shortest = std::move(fewer);
    }
    return shortest;
}

std::string percent(double share) {
    const double p = share * 100.0;
    return p > 0.0 && p < 1.0 ? fmt::format("{:.1f} %", p) : fmt::format("{:.0f} %", p);
}

std::string choice_label(const std::string& choice) {
    if (choice == "srgb") return "sRGB";
    if (choice == "s106") return "S106";
    if (choice == "") return "None";
    if (choice == "true") return "Yes";
    if (choice == "false") return "No";
    std::string label = choice;
    std::replace(label.begin(), label.end(), '-', ' ');
    if (label[0] >= 'a' && label[0] <= 'z') label[0] = static_cast<char>(label[0] - 'a' + 'A');
    return label;
}

std::string in_words(const ParameterSpec& spec, const Value& value) {
    const bool file = spec.type == ParameterType::file || spec.type == ParameterType::files;
    if (value == spec.nothing && spec.type != ParameterType::words && !file) return "Auto";
    if (const Value::List* list = value.list()) {
        if (spec.type == ParameterType::curve) return fmt::format("{} points", list->size());
        std::string text;
        for (const Value& element : *list) text += (text.empty() ? "" : ", ") + in_words(spec, element);
        return text;
    }
    if (const std::string* text = value.text()) {
        const bool named = std::find(spec.choices.begin(), spec.choices.end(), *text) != spec.choices.end();
        if (named || *text == "auto") return choice_label(*text);
        return file ? file_name(*text) : *text;
    }
    if (const bool* yes = std::get_if<bool>(&value.data)) return *yes ? "Yes" : "No";
    if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return figures(*integer);
    return figures(value.number());
}

std::string tooltip_text(const ParameterSpec& spec, const Value& standard) {
    std::string text = spec.label + ": " + spec.help + "\n" + spec.key.text();
    text += "\nTakes " + expectation(spec);
    if (!spec.unit.empty()) text += ", " + spec.unit;
    const bool says_nothing = standard.is_number() && standard.number() == 0.0 && !spec.zero.empty();
    text += "; default " +
            (says_nothing ? fmt::format("{} ({})", spec.zero, to_toml(standard)) : to_toml(standard));
    if (spec.animation == Animation::steps) text += "; animated in steps";
    return text;
}

std::string set_option(const std::string& key, const Value& value) {
    return "--set " + shell_word(key + "=" + to_toml(value));
}

double drag_step(const ParameterSpec& spec, double value) {
    constexpr double pixels = 250.0;  // from one end of a short range to the other
    const double range = spec.slider_max - spec.slider_min;
    const bool closed = spec.min >= spec.slider_min && spec.max <= spec.slider_max;
    const double size = std::fabs(value);
    if (spec.scale == Scale::logarithmic) return std::max(size * 0.01, spec.slider_min * 0.01);
    if (spec.type == ParameterType::integer) return std::max(std::min(range / pixels, size * 0.01), 0.05);
    if (closed) return range / pixels;
    if (spec.slider_min < 0.0) return std::min(range / pixels, std::max(size * 0.02, range / 1000.0));
    return std::min(range / pixels, std::max(size * 0.02, range / 5000.0));
}

}  // namespace astrosplat::panel
