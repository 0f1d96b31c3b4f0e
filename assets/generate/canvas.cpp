// Painting and saving; OpenImageIO writes the files.
#include "canvas.h"

#include <fmt/format.h>

#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"

namespace astrosplat::assets {
namespace {

unsigned char encoded(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    const float y = x <= 0.0031308f ? 12.92f * x : 1.055f * shared::as_pow(x, 1.0f / 2.4f) - 0.055f;
    return static_cast<unsigned char>(y * 255.0f + 0.5f);
}

std::vector<unsigned char> bytes(const Canvas& canvas, int channels) {
    std::vector<unsigned char> out(canvas.pixels.size() * channels);
    for (std::size_t i = 0; i < canvas.pixels.size(); ++i) {
        const glm::vec4& p = canvas.pixels[i];
        for (int c = 0; c < 3; ++c) out[i * channels + c] = encoded(p[c]);
        if (channels == 4)
            out[i * 4 + 3] = static_cast<unsigned char>(std::clamp(p.w, 0.0f, 1.0f) * 255.0f + 0.5f);
    }
    return out;
}

void save(const Canvas& canvas, const std::filesystem::path& file, OIIO::ImageSpec spec) {
    const auto output = OIIO::ImageOutput::create(file.string());
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 9);
    if (!output || !output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, bytes(canvas, spec.nchannels).data()) || !output->close())
        throw OutputError(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace

Canvas make_canvas(int width, int height) {
    return {width, height, std::vector<glm::vec4>(static_cast<std::size_t>(width) * height, glm::vec4(0.0f))};
}

void paint(Canvas& canvas, const std::function<glm::vec4(float u, float v)>& color) {
    parallel_for(canvas.height, [&](std::int64_t row, int) {
        const int y = static_cast<int>(row);
        const float v = 1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(canvas.height);
        for (int x = 0; x < canvas.width; ++x)
            canvas.at(x, y) = color((static_cast<float>(x) + 0.5f) / static_cast<float>(canvas.width), v);
    });
}

void add_glow(Canvas& canvas, glm::vec2 place_px, glm::vec3 flux, float sigma_px) {
    const float reach = 4.0f * sigma_px + 1.0f;
    const int x0 = std::max(0, static_cast<int>(std::floor(place_px.x - reach)));
    const int x1 = std::min(canvas.width - 1, static_cast<int>(std::floor(place_px.x + reach)));
    const int y0 = std::max(0, static_cast<int>(std::floor(place_px.y - reach)));
    const int y1 = std::min(canvas.height - 1, static_cast<int>(std::floor(place_px.y + reach)));
    const float scale = 1.0f / (2.0f * sigma_px * sigma_px);
    const glm::vec3 peak = flux * (scale / static_cast<float>(real::pi));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const float dx = static_cast<float>(x) + 0.5f - place_px.x,
                        dy = static_cast<float>(y) + 0.5f - place_px.y;
            canvas.at(x, y) += glm::vec4(peak * shared::as_exp(-(dx * dx + dy * dy) * scale), 0.0f);
        }
}

glm::vec3 asinh_curve(glm::vec3 light, float softening, float white) {
    const float top = std::max({light.x, light.y, light.z});
    if (top <= 0.0f) return glm::vec3(0.0f);
    const auto curve = [&](float x) {
        return static_cast<float>(real::asinh(static_cast<double>(x / softening)));
    };
    return light * (curve(top) / (curve(white) * top));
}

float luminance(glm::vec3 color) { return 0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z; }

void save_jpeg(const Canvas& canvas, const std::filesystem::path& file, int quality) {
    OIIO::ImageSpec spec(canvas.width, canvas.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("Compression", fmt::format("jpeg:{}", quality));
    spec.attribute("jpeg:subsampling", "4:2:0");
    save(canvas, file, spec);
}

void save_png(const Canvas& canvas, const std::filesystem::path& file, int channels) {
    save(canvas, file, OIIO::ImageSpec(canvas.width, canvas.height, channels, OIIO::TypeDesc::UINT8));
}

}  // namespace astrosplat::assets
