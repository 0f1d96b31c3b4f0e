// Reading a configuration, and the way of light through it.
#include "ocio/processor.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "core/primaries.h"
#include "core/text.h"
#include "ocio/display_transform.h"

namespace astrosplat {
namespace fs = std::filesystem;

namespace {

// As OpenColorIO's header has them; these two are data, which a library that is loaded late does not give.
constexpr const char* interchange_role = "aces_interchange";
constexpr const char* linear_role = "scene_linear";

/// Names that published configurations have for linear light with the primaries of Rec. 709.
constexpr const char* linear_rec709_names[] = {
    "lin_rec709_srgb",           "lin_rec709",     "lin_srgb",
    "Linear Rec.709 (sRGB)",     "Linear Rec.709", "Utility - Linear - sRGB",
    "Utility - Linear - Rec.709"};

/// ACES2065-1: the primaries AP0 of the Academy's ST 2065-1 and the ACES white.
constexpr Chromaticities aces_chromaticities{
    {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};

}  // namespace

std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

ocio::ConstConfigRcPtr load_config(const fs::path& file) {
    require_readable(file);
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    ocio::ClearAllCaches();  // of tables that may have been written anew
    try {
        return ocio::Config::CreateFromFile(file.c_str());
    } catch (const std::exception& error) {
        bad_input(file.string(), "", "a configuration of OpenColorIO", one_line(error.what()));
    }
}

std::vector<std::string> displays_of(const ocio::Config& config) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumDisplays(); ++i) names.emplace_back(config.getDisplay(i));
    return names;
}

std::vector<std::string> views_of(const ocio::Config& config, const std::string& display) {
    std::vector<std::string> names;
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        names.emplace_back(config.getView(display.c_str(), i));
    return names;
}

std::string chosen(const char* key, const std::string& wanted, const std::string& standard,
                   const std::vector<std::string>& known, const fs::path& file) {
    const std::string& name = wanted.empty() ? standard : wanted;
    if (std::ranges::find(known, name) != known.end()) return name;
    throw OcioError(key, fmt::format("expected {} of {}, found {}",
                                     known.empty() ? "one, but there is none" : alternatives(known),
                                     file.string(), name.empty() ? "none" : "'" + name + "'"));
}

LightEntry entry_of(const ocio::Config& config, const OcioParams& params, const fs::path& file) {
    const auto has = [&](const char* name) { return bool(config.getColorSpace(name)); };
    if (!params.space.empty()) {
        if (has(params.space.c_str())) return {params.space};
        throw OcioError("output.ocio.space", fmt::format("expected a colour space of {}, found '{}'",
                                                         file.string(), params.space));
    }
    for (const char* name : linear_rec709_names)
        if (has(name)) return {name};
    if (config.hasRole(interchange_role)) return {interchange_role, true};
    if (config.hasRole(linear_role)) return {linear_role};
    throw OcioError("output.ocio.space",
                    fmt::format("expected the name of linear Rec. 709 light in {}, which has no role {}, "
                                "found none",
                                file.string(), linear_role));
}

ocio::ConstProcessorRcPtr processor_for(const ocio::Config& config, const LightEntry& entry,
                                        const std::string& display, const std::string& view) {
    const ocio::GroupTransformRcPtr all = ocio::GroupTransform::Create();
    if (entry.from_aces) {
        const glm::dmat3 m = primaries_matrix(rec709_chromaticities, aces_chromaticities);
        double rows[16] = {};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) rows[4 * row + column] = m[column][row];
        rows[15] = 1.0;
        const ocio::MatrixTransformRcPtr matrix = ocio::MatrixTransform::Create();
        matrix->setMatrix(rows);
        all->appendTransform(matrix);
    }
    const ocio::DisplayViewTransformRcPtr shown = ocio::DisplayViewTransform::Create();
    shown->setSrc(entry.space.c_str());
    shown->setDisplay(display.c_str());
    shown->setView(view.c_str());
    all->appendTransform(shown);
    return config.getProcessor(all);
}

}  // namespace astrosplat
