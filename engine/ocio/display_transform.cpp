// OpenColorIO's processors, made with settings that lose nothing.
#include "ocio/display_transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <list>
#include <mutex>

#include "core/file.h"
#include "ocio/processor.h"

namespace astrosplat {
namespace fs = std::filesystem;

namespace {

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
    const std::size_t count = std::size_t{width} * height * static_cast<unsigned>(channels);
    return {sampler,
            height > 1 ? 2 : 1,
            static_cast<int>(width),
            int(height),
            channels,
            interpolation != ocio::INTERP_NEAREST,
            {values, values + count}};
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
    return {sampler, 3, static_cast<int>(edge), static_cast<int>(edge), 3, smooth, {values, values + count}};
}

}  // namespace

OcioError::OcioError(std::string of_key, const std::string& message)
    : InputError(of_key + ": " + message), key(std::move(of_key)) {}

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
        bad_input(file.string(), "", fmt::format("a view '{}' that can be made", state.view),
                  one_line(error.what()));
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
