#include "analytic/support.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include <OpenImageIO/imageio.h>

#include <stdexcept>

#include "frame/output_pattern.h"
#include "output/write.h"
#include "scene/load.h"
#include "support/frames.h"

namespace astrosplat::analytic {
namespace {

void write_image(const fs::path& file, const char* plugin, OIIO::TypeDesc type, int width, int height,
                 const Texels& texels) {
    std::vector<float> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec4 texel = texels(x, y);
            values.insert(values.end(), {texel.r, texel.g, texel.b, texel.a});
        }
    OIIO::ImageSpec spec(width, height, 4, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    auto out = OIIO::ImageOutput::create(plugin);
    if (!out || !out->open(file.string(), spec) || !out->write_image(OIIO::TypeDesc::FLOAT, values.data()) ||
        !out->close())
        throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

void write_float_tiff(const fs::path& file, int width, int height, const Texels& texels) {
    write_image(file, "tiff", OIIO::TypeDesc::FLOAT, width, height, texels);
}

void write_png(const fs::path& file, int width, int height, const Texels& texels) {
    write_image(file, "png", OIIO::TypeDesc::UINT8, width, height, texels);
}

float StoredFile::at(const std::string& name, std::int64_t x, std::int64_t y) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::out_of_range("no channel " + name);
    return image.at(x, y)[found - names.begin()];
}

StoredFile read_stored_file(const fs::path& file) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    auto in = OIIO::ImageInput::open(file.string(), &config);
    if (!in) throw std::runtime_error(file.string() + ": " + OIIO::geterror());
    const OIIO::ImageSpec& spec = in->spec();
    StoredFile stored;
    stored.image = make_image(spec.width, spec.height, spec.nchannels);
    if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, stored.image.pixels.data()))
        throw std::runtime_error(file.string() + ": " + in->geterror());
    for (int c = 0; c < spec.nchannels; ++c) {
        stored.names.push_back(spec.channelnames[std::size_t(c)]);
        stored.types.emplace_back(spec.channelformat(c).c_str());
    }
    return stored;
}

std::string pda(const std::string& rows) {
    return fmt::format(
        "ATTRIBUTES\nposition rgbPP opacityPP radiusPP\nTYPES\nV V R R\nNUMBER_OF_PARTICLES: {}\nBEGIN "
        "DATA\n{}",
        std::ranges::count(rows, '\n'), rows);
}

Scene scene_of(const TempFolder& folder, const std::string& toml) {
    return parse_scene(toml, folder / "scene.toml");
}

RenderedFrame render_frame(Pipeline& pipeline, double frame) { return frame_of(pipeline, frame); }

RenderedFrame render_text(const TempFolder& folder, const std::string& toml, double frame) {
    Pipeline pipeline(scene_of(folder, toml));
    return render_frame(pipeline, frame);
}

fs::path write_text(const TempFolder& folder, const std::string& toml) {
    const Scene scene = scene_of(folder, toml);
    Pipeline pipeline(scene);
    const RenderedFrame frame = render_frame(pipeline);
    const fs::path file = OutputPattern{folder.path(), scene.output.path}.resolve(1);
    const OutputParams& output = scene.output;
    write_frame(
        {file, output, output.width, output.height, {}, pipeline.layer_names(pipeline.frame_scene(1.0))},
        frame, {});
    return file;
}

glm::dvec4 mean(const Image& image, Region part) {
    if (part.width <= 0) part = {0, 0, image.width, image.height};
    glm::dvec4 sum(0.0);
    for (std::int64_t y = part.y; y < part.y + part.height; ++y)
        for (std::int64_t x = part.x; x < part.x + part.width; ++x)
            for (int k = 0; k < 4; ++k) sum[k] += image.at(x, y)[k];
    return sum / double(part.width * part.height);
}

}  // namespace astrosplat::analytic
