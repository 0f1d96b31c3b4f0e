// Reading a configuration, the way of light through it, and OpenColorIO's processors, made with settings that
// lose nothing.
#include "ocio/display_transform.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include <cstdlib>
#include <list>
#include <mutex>

#include "core/color.h"
#include "core/file.h"
#include "core/text.h"

namespace astrosplat {
namespace ocio = OCIO_NAMESPACE;

OcioError::OcioError(std::string of_key, const std::string& message)
    : InputError(of_key + ": " + message), key(std::move(of_key)) {}

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

/// OpenColorIO's messages may have several lines.
std::string one_line(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

/// Throws InputError.
ocio::ConstConfigRcPtr load_config(const fs::path& file) {
    // "ocio://default" and its like; a scene's path to it lies in the scene's folder. Frames are named by the
    // bytes of a file, which these are not, and Debian 12's OpenColorIO 2.1 has none.
    if (std::ranges::find(file, fs::path("ocio:")) != file.end())
        bad_input(fmt::format("ocio://{}", file.filename().string()), "a configuration's file",
                  "one of those inside OpenColorIO 2.2 and newer, which are not read (they are published as "
                  "files, too)");
    require_readable(file);
    ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
    ocio::ClearAllCaches();  // of tables that may have been written anew
    try {
        return ocio::Config::CreateFromFile(file.c_str());
    } catch (const std::exception& error) {
        bad_input(file, "a configuration of OpenColorIO", one_line(error.what()));
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

/// `wanted`, or the standard where it is empty. Throws OcioError of `key` where it is not one of the known.
std::string chosen(const char* key, const std::string& wanted, const std::string& standard,
                   const std::vector<std::string>& known, const fs::path& file) {
    const std::string& name = wanted.empty() ? standard : wanted;
    if (std::ranges::find(known, name) != known.end()) return name;
    throw OcioError(key, fmt::format("expected {} of {}, found {}",
                                     known.empty() ? "one, but there is none" : alternatives(known),
                                     file.string(), name.empty() ? "none" : "'" + name + "'"));
}

/// Where scene light enters the configuration.
struct LightEntry {
    std::string space;
    bool from_aces = false;  // the space is ACES2065-1
};

/// Throws OcioError.
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

/// Throws what OpenColorIO throws.
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

std::vector<fs::path> files_of(const ocio::ConstProcessorRcPtr& processor, const fs::path& config) {
    std::vector<fs::path> files{config};
    const ocio::ConstProcessorMetadataRcPtr metadata = processor->getProcessorMetadata();
    for (int i = 0; i < metadata->getNumFiles(); ++i) files.emplace_back(metadata->getFile(i));
    return files;
}

/// One of these at a time is enough for a batch; a window has a few.
struct Kept {
    OcioParams params;
    std::vector<fs::path> files;
    std::vector<FileStamp> stamps;
    std::shared_ptr<const DisplayTransform> transform;
};

std::vector<FileStamp> stamps_of(const std::vector<fs::path>& files) {
    std::vector<FileStamp> stamps;
    for (const fs::path& file : files) stamps.push_back(stamp_of(file));
    return stamps;
}

GlslTable plane_table(const ocio::GpuShaderDesc& shader, unsigned index) {
    const char *texture = nullptr, *sampler = nullptr;
    unsigned width = 0, height = 0;
    ocio::GpuShaderCreator::TextureType channel = ocio::GpuShaderCreator::TEXTURE_RGB_CHANNEL;
    ocio::Interpolation interpolation = ocio::INTERP_LINEAR;
    shader.getTexture(index, texture, sampler, width, height, channel, interpolation);
    const float* values = nullptr;
    shader.getTextureValues(index, values);
    const int channels = channel == ocio::GpuShaderCreator::TEXTURE_RED_CHANNEL ? 1 : 3;
    const int w = int(width), h = int(height);
    const float* const end = values + std::size_t{width} * height * unsigned(channels);
    return {sampler, h > 1 ? 2 : 1, w, h, channels, interpolation != ocio::INTERP_NEAREST, {values, end}};
}

GlslTable cube_table(const ocio::GpuShaderDesc& shader, unsigned index) {
    const char *texture = nullptr, *sampler = nullptr;
    unsigned edge = 0;
    ocio::Interpolation interpolation = ocio::INTERP_LINEAR;
    shader.get3DTexture(index, texture, sampler, edge, interpolation);
    const float* values = nullptr;
    shader.get3DTextureValues(index, values);
    const std::size_t count = std::size_t{3} * edge * edge * edge;
    const bool smooth = interpolation != ocio::INTERP_NEAREST && interpolation != ocio::INTERP_TETRAHEDRAL;
    return {sampler, 3, int(edge), int(edge), 3, smooth, {values, values + count}};
}

}  // namespace

struct DisplayTransform::State {
    std::string display, view, space;
    std::vector<fs::path> files;
    ocio::ConstProcessorRcPtr processor;
    ocio::ConstCPUProcessorRcPtr cpu;
};

fs::path config_file(const OcioParams& params) {
    if (!params.config.empty()) return params.config;
    const char* const named = std::getenv("OCIO");
    return named ? fs::path(named) : fs::path();
}

ColorConfig read_color_config(const fs::path& file) {
    const ocio::ConstConfigRcPtr config = load_config(file);
    ColorConfig result{file, {}, config->getDefaultDisplay()};
    for (const std::string& display : displays_of(*config))
        result.displays.push_back(
            {display, views_of(*config, display), config->getDefaultView(display.c_str())});
    return result;
}

DisplayTransform::DisplayTransform(const OcioParams& params) : state_(std::make_unique<State>()) {
    const fs::path file = config_file(params);
    if (file.empty())
        throw OcioError("output.ocio.config",
                        "expected a file, as the environment's OCIO names none, found none");
    const ocio::ConstConfigRcPtr config = load_config(file);
    State& state = *state_;
    state.display = chosen("output.ocio.display", params.display, config->getDefaultDisplay(),
                           displays_of(*config), file);
    state.view = chosen("output.ocio.view", params.view, config->getDefaultView(state.display.c_str()),
                        views_of(*config, state.display), file);
    const LightEntry entry = entry_of(*config, params, file);
    state.space = entry.space;
    try {
        state.processor = processor_for(*config, entry, state.display, state.view);
        state.cpu = state.processor->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    } catch (const std::exception& error) {
        bad_input(file, fmt::format("a view '{}' that can be made", state.view), one_line(error.what()));
    }
    state.files = files_of(state.processor, file);
}

DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(float* rgb, std::int64_t pixels) const {
    ocio::PackedImageDesc row(rgb, static_cast<long>(pixels), 1, 3);
    state_->cpu->apply(row);
    for (float* value = rgb; value != rgb + 3 * pixels; ++value)
        *value = *value > 0.0f ? std::fmin(*value, 1.0f) : 0.0f;
}

GlslTransform DisplayTransform::glsl() const {
    ocio::GpuShaderDescRcPtr shader = ocio::GpuShaderDesc::CreateShaderDesc();
    shader->setLanguage(ocio::GPU_LANGUAGE_GLSL_4_0);
    shader->setFunctionName("ocio_display");
    shader->setResourcePrefix("ocio_");
    state_->processor->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
    GlslTransform result{shader->getShaderText(), {}};
    for (unsigned i = 0; i < shader->getNumTextures(); ++i) result.tables.push_back(plane_table(*shader, i));
    for (unsigned i = 0; i < shader->getNum3DTextures(); ++i) result.tables.push_back(cube_table(*shader, i));
    return result;
}

const std::string& DisplayTransform::display() const { return state_->display; }
const std::string& DisplayTransform::view() const { return state_->view; }
const std::string& DisplayTransform::space() const { return state_->space; }
const std::vector<fs::path>& DisplayTransform::files() const { return state_->files; }

std::shared_ptr<const DisplayTransform> display_transform(const OcioParams& params) {
    static std::mutex mutex;
    static std::list<Kept> kept;  // used last first
    const std::lock_guard lock(mutex);
    const fs::path file = config_file(params);
    const auto found = std::ranges::find_if(kept, [&](const Kept& each) {
        return each.params == params && each.files.front() == file && each.stamps == stamps_of(each.files);
    });
    if (found != kept.end()) {
        kept.splice(kept.begin(), kept, found);
        return found->transform;
    }
    auto made = std::make_shared<const DisplayTransform>(params);
    kept.push_front({params, made->files(), stamps_of(made->files()), made});
    if (kept.size() > 4) kept.pop_back();
    return made;
}

std::string ocio_version() { return ocio::GetVersion(); }

}  // namespace astrosplat
