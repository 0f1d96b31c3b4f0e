// Words to numbers, a message for each that is none.
#include "prepare_settings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/text.h"

namespace astrosplat {
namespace {

double number_above_zero(const char* option, const std::string& text) {
    const std::optional<double> value = parse_double(text);
    if (!value || !(*value > 0.0) || !std::isfinite(*value))
        bad_input(option, "", "a number above 0", "'" + text + "'");
    return *value;
}

void set_above_zero(const char* option, const std::optional<std::string>& text, double& value) {
    if (text) value = number_above_zero(option, *text);
}

// Numbers with commas between them; empty where one is none.
std::vector<double> numbers(const std::string& text) {
    std::vector<double> values;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::optional<double> value = parse_double(text.substr(begin, end - begin));
        if (!value || !std::isfinite(*value)) return {};
        values.push_back(*value);
        begin = end + 1;
    }
    return values;
}

TextureSettings::Stretch stretch_named(const std::string& name) {
    const std::vector<std::string> names = all_names<TextureSettings::Stretch>();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) bad_input("--stretch", "", alternatives(names), "'" + name + "'");
    return static_cast<TextureSettings::Stretch>(found - names.begin());
}

int degree_named(const std::string& name) {
    const std::vector<std::string> names = {"level", "plane", "curved"};
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) bad_input("--background", "", alternatives(names), "'" + name + "'");
    return static_cast<int>(found - names.begin());
}

CutEllipse ellipse_of(const PrepareOptions& options) {
    const std::vector<double> n = numbers(*options.ellipse);
    if (n.size() < 4 || n.size() > 5 || !(n[2] > 0.0) || !(n[3] > 0.0))
        bad_input("--ellipse", "", "X,Y,RX,RY or X,Y,RX,RY,ANGLE with radii above 0",
                  "'" + *options.ellipse + "'");
    CutEllipse ellipse{{n[0], n[1]}, {n[2], n[3]}, n.size() > 4 ? n[4] : 0.0};
    if (!options.feather) return ellipse;
    const std::optional<double> feather = parse_double(*options.feather);
    if (!feather || !(*feather >= 0.0) || !(*feather <= 1.0))
        bad_input("--feather", "", "a number from 0 to 1", "'" + *options.feather + "'");
    ellipse.feather = *feather;
    return ellipse;
}

std::pair<double, double> luminances_of(const std::string& text) {
    const std::vector<double> n = numbers(text);
    if (n.size() != 2 || !(n[0] < n[1]))
        bad_input("--alpha", "", "LOW,HIGH with LOW below HIGH", "'" + text + "'");
    return {n[0], n[1]};
}

bool three_filters(const PrepareOptions& options) {
    const int given = !options.red.empty() + !options.green.empty() + !options.blue.empty();
    if (given != 0 && (given != 3 || !options.image.empty()))
        bad_input(
            "--r, --g, --b", "", "all three and no other picture",
            given == 3 ? "'" + options.image.string() + "' as well" : std::to_string(given) + " of them");
    if (given == 0 && options.image.empty())
        bad_input("prepare", "", "a picture, or --r, --g and --b", "none");
    return given == 3;
}

}  // namespace

PrepareSettings prepare_settings(const PrepareOptions& options) {
    PrepareSettings settings;
    settings.three_filters = three_filters(options);
    if (options.stretch) settings.texture.stretch = stretch_named(*options.stretch);
    if (options.stretch && settings.three_filters)
        bad_input("--stretch", "", "--q and --lupton-stretch for three filters",
                  "'" + *options.stretch + "'");
    set_above_zero("--threshold", options.threshold, settings.stars.threshold);
    set_above_zero("--saturation", options.saturation, settings.stars.saturation);
    set_above_zero("--q", options.q, settings.lupton.q);
    set_above_zero("--lupton-stretch", options.lupton, settings.lupton.stretch);
    if (options.background) settings.sky_degree = degree_named(*options.background);
    if (options.feather && !options.ellipse) bad_input("--feather", "", "--ellipse beside it", "none");
    if (options.ellipse) settings.ellipse = ellipse_of(options);
    if (options.alpha) settings.alpha = luminances_of(*options.alpha);
    return settings;
}

}  // namespace astrosplat
