#include "bodies/margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/log.h"
#include "core/parallel.h"
#include "core/shared_noise.h"
#include "image/area.h"
#include "image/channels.h"
#include "source/picture_camera.h"

namespace astrosplat {
namespace {

constexpr std::int64_t margin_rows = 16;
constexpr std::int64_t local_px = 48;     // pixels along the longer side of the local brightness
constexpr float brightest_detail = 1.6f;  // times the local brightness; what is brighter is a star
constexpr std::uint32_t outline_seed = 0xed6eu;

float fourth_root(float v) { return std::sqrt(std::sqrt(std::max(v, 0.0f))); }

// The mean of fourth roots, which a star hardly moves.
Image local_brightness(const Image& image) {
    Image roots = unfilled_image(image.width, image.height, 3);
    parallel_chunks(image.height, margin_rows, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t i = begin * image.width; i < end * image.width; ++i)
            for (std::int64_t c = 0; c < 3; ++c)
                roots.pixels[static_cast<std::size_t>(3 * i + c)] =
                    fourth_root(image.pixels[static_cast<std::size_t>(image.channels * i + c)]);
    });
    const double ratio = std::min(
        1.0, static_cast<double>(local_px) / static_cast<double>(std::max(image.width, image.height)));
    const auto side = [&](std::int64_t px) {
        return std::max<std::int64_t>(1, std::llround(ratio * static_cast<double>(px)));
    };
    return reduced_by_area(roots, side(image.width), side(image.height));
}

// px beyond the picture, along one side.
std::int64_t beyond(std::int64_t i, std::int64_t count) {
    return std::max({-i, i - count + 1, std::int64_t{0}});
}

std::int64_t mirrored(std::int64_t i, std::int64_t count) {
    const std::int64_t in = i < 0 ? -1 - i : i >= count ? 2 * count - 1 - i : i;
    return std::clamp<std::int64_t>(in, 0, count - 1);
}

float smooth_step(float t) { return t * t * (3.0f - 2.0f * t); }

// 1 at the picture's edge, 0 at most `margin` px away from it: an outline with bays of several sizes, nearer
// to the picture at its corners. In: px from the middle, as shares of half the picture; px from the picture.
float fade_at(glm::vec2 from_middle, glm::vec2 px, float away_px, float margin_px) {
    constexpr float bays[] = {0.45f, 0.3f, 0.2f}, raggedness = 0.8f, steepness = 1.0f;
    float noise = 0.0f, frequency = 0.5f / margin_px;
    for (std::uint32_t octave = 0; octave < 3; ++octave, frequency *= 2.2f)
        noise +=
            bays[octave] * shared::as_noise(px.x * frequency, px.y * frequency, 0.5f, outline_seed + octave);
    const float corner = std::fabs(from_middle.x * from_middle.y), way = away_px / margin_px;
    const float ragged = way * (steepness + corner * corner + raggedness * std::clamp(noise, -1.0f, 1.0f));
    const float fade =
        smooth_step(1.0f - std::clamp(ragged, 0.0f, 1.0f)) * smooth_step(1.0f - std::min(way, 1.0f));
    return fade * std::sqrt(fade);
}

Image continued(const Texture& texture, std::int64_t margin_px) {
    const Image& image = texture.image;
    const Image local = local_brightness(image);
    Image out = unfilled_image(image.width + 2 * margin_px, image.height + 2 * margin_px, image.channels);
    const glm::vec2 middle(0.5f * static_cast<float>(image.width), 0.5f * static_cast<float>(image.height));
    const float to_local = static_cast<float>(local.width) / static_cast<float>(image.width);
    parallel_chunks(out.height, margin_rows, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t column = 0; column < out.width; ++column) {
                const std::int64_t x = column - margin_px, y = row - margin_px;
                const std::int64_t from_x = mirrored(x, image.width), from_y = mirrored(y, image.height);
                const std::int64_t dx = beyond(x, image.width), dy = beyond(y, image.height);
                const float* const in = image.at(from_x, from_y);
                float* const to = out.at(column, row);
                std::copy_n(in, image.channels, to);
                if (texture.alpha_from_light) to[3] = 1.0f;
                if (dx == 0 && dy == 0) continue;
                const float away = std::sqrt(static_cast<float>(dx * dx + dy * dy));
                const glm::vec2 px(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const float fade = fade_at(px / middle - 1.0f, px, away, static_cast<float>(margin_px));
                const LinearSample near(local, (static_cast<float>(from_x) + 0.5f) * to_local,
                                        (static_cast<float>(from_y) + 0.5f) * to_local);
                for (int c = 0; c < 3; ++c) {
                    const float root = near.of(local, c);
                    to[c] = fade * std::min(to[c], brightest_detail * root * root * root * root);
                }
                to[3] *= fade;
            }
        }
    });
    return out;
}

glm::dvec2 add_margin(TexturedMesh& mesh, double margin) {
    Texture& texture = mesh.textures.front();
    const auto width = static_cast<double>(texture.image.width),
               height = static_cast<double>(texture.image.height);
    const std::int64_t margin_px = std::llround(margin * width);
    if (margin_px == 0) return {1.0, 1.0};
    texture.image = continued(texture, margin_px);
    texture.alpha_from_light = false;
    const glm::dvec2 times(static_cast<double>(texture.image.width) / width,
                           static_cast<double>(texture.image.height) / height);
    for (glm::vec3& p : mesh.mesh.positions)
        p = {static_cast<float>(p.x * times.x), p.y, static_cast<float>(p.z * times.y)};
    if (mesh.camera) mesh.camera = widened(*mesh.camera, times);
    if (mesh.camera) apply_camera_uv(mesh.mesh, *mesh.camera);
    return times;
}

}  // namespace

Image mirrored_margin(const Image& image, double margin) {
    const auto margin_px = std::llround(static_cast<double>(image.width) * margin / (1.0 + 2.0 * margin));
    const std::int64_t width = image.width - 2 * margin_px, height = image.height - 2 * margin_px;
    Image out = unfilled_image(image.width, image.height, image.channels);
    parallel_chunks(out.height, margin_rows, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t y = begin; y < end; ++y)
            for (std::int64_t x = 0; x < out.width; ++x)
                std::copy_n(image.at(margin_px + mirrored(x - margin_px, width),
                                     margin_px + mirrored(y - margin_px, height)),
                            image.channels, out.at(x, y));
    });
    return out;
}

std::vector<glm::dvec2> add_margins(std::vector<TexturedMesh>& meshes, double margin,
                                    const std::string& layer_name) {
    std::vector<glm::dvec2> times(meshes.size(), glm::dvec2(1.0));
    if (margin <= 0.0) return times;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i].mesh.name == "plane")
            times[i] = add_margin(meshes[i], margin);
        else
            log_warning(fmt::format("layer '{}': source.structure.margin acts on planes only, not on '{}'",
                                    layer_name, meshes[i].mesh.name));
    }
    return times;
}

}  // namespace astrosplat
