#include "bodies/margin.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "bodies/galaxies.h"
#include "core/log.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// Found in films of W5, the Bubble, M42 and Sh2-106: no straight edge and no corner stands out.
// Pixels along the longer side of the local brightness; more where no details are added to it, by which
// the rim of Comet ISON's picture goes on without a step.
constexpr std::int64_t local_px = 48, local_px_of_smooth = 192;
constexpr float brightest_detail = 1.6f;  // times the local brightness; what is brighter is a star
constexpr float least_reach = 0.6f;       // of the margin, that what is lit goes on
constexpr float dark_light = 0.004f, dark_share = 0.1f;  // light that is dark, and of the brightest rim
constexpr std::uint32_t outline_seed = 0xed6eu;

float fourth_root(float v) { return std::sqrt(std::sqrt(std::max(v, 0.0f))); }

// The mean of fourth roots, which a star hardly moves.
Image local_brightness(const Image& image, std::int64_t longest_px) {
    Image roots = unfilled_image(image.width, image.height, 3);
    for_each_pixel(image, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < 3; ++c) roots.at(x, y)[c] = fourth_root(image.at(x, y)[c]);
    });
    const double ratio = std::min(1.0, double(longest_px) / double(std::max(image.width, image.height)));
    const auto side = [&](std::int64_t px) {
        return std::max<std::int64_t>(1, std::llround(ratio * double(px)));
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

// Inputs of a texel beyond the picture, besides the picture itself.
struct Surroundings {
    Image local;             // brightness, as fourth roots
    float to_local = 1.0f;   // pixels of `local` in one of the picture
    float brightest = 0.0f;  // of `local` along the rim, as light
    glm::vec2 middle{0.0f};  // of the picture, px
    float margin_px = 0.0f;

    glm::vec3 light_at(std::int64_t x, std::int64_t y) const {
        const LinearSample near(local, (float(x) + 0.5f) * to_local, (float(y) + 0.5f) * to_local);
        const glm::vec3 root(near.of(local, 0), near.of(local, 1), near.of(local, 2));
        return root * root * root * root;
    }
};

float brightest_of(const glm::vec3& light) { return std::max({light.r, light.g, light.b}); }

Surroundings surroundings_of(const Image& image, std::int64_t margin_px, bool smooth) {
    Surroundings around;
    around.local = local_brightness(image, smooth ? local_px_of_smooth : local_px);
    around.to_local = float(around.local.width) / float(image.width);
    around.middle = 0.5f * glm::vec2(float(image.width), float(image.height));
    around.margin_px = float(margin_px);
    const auto see = [&](std::int64_t x, std::int64_t y) {
        around.brightest = std::max(around.brightest, brightest_of(around.light_at(x, y)));
    };
    for (std::int64_t x = 0; x < image.width; ++x) see(x, 0), see(x, image.height - 1);
    for (std::int64_t y = 0; y < image.height; ++y) see(0, y), see(image.width - 1, y);
    return around;
}

// How far light goes on from a place on the rim, as a share of the margin: the farther the brighter it is.
float reach_of(float rim_light, float brightest_rim) {
    const float dark = std::min(dark_light, dark_share * brightest_rim);
    if (dark <= 0.0f) return least_reach;
    const float share =
        shared::as_log(std::max(rim_light, dark) / dark) / shared::as_log(brightest_rim / dark);
    return least_reach + (1.0f - least_reach) * std::min(share, 1.0f);
}

// 1 at the picture's edge, 0 at most `reach_px` away from it: an outline with bays of several sizes. In: px
// from the picture's upper left.
float fade_at(const Surroundings& around, glm::vec2 px, float away_px, float reach_px) {
    constexpr float bays[] = {0.45f, 0.3f, 0.2f}, raggedness = 1.1f, steepness = 1.0f;
    constexpr float widest_bay = 2.0f, bay_ratio = 2.2f;  // in margins; of each size to the next
    float noise = 0.0f, frequency = 1.0f / widest_bay / around.margin_px;
    for (std::uint32_t octave = 0; octave < 3; ++octave, frequency *= bay_ratio)
        noise +=
            bays[octave] * shared::as_noise(px.x * frequency, px.y * frequency, 0.5f, outline_seed + octave);
    const float way = away_px / reach_px;
    const float ragged = way * (steepness + raggedness * std::clamp(noise, -1.0f, 1.0f));
    return real::smoothstep(1.0f - std::clamp(ragged, 0.0f, 1.0f)) *
           real::smoothstep(1.0f - std::min(way, 1.0f));
}

// The texel at x, y of the picture, which lies beyond it: its mirrored details on the light of the rim, which
// would otherwise rise again towards what is bright. `detail`: the share of these; where light is smooth,
// they would be a second head of a comet.
void continue_texel(const Surroundings& around, const Image& image, std::int64_t x, std::int64_t y,
                    float detail, float* to) {
    const std::int64_t from_x = mirrored(x, image.width), from_y = mirrored(y, image.height);
    const auto dx = float(beyond(x, image.width)), dy = float(beyond(y, image.height));
    const glm::vec3 rim = around.light_at(std::clamp<std::int64_t>(x, 0, image.width - 1),
                                          std::clamp<std::int64_t>(y, 0, image.height - 1));
    const float reach_px = around.margin_px * reach_of(brightest_of(rim), around.brightest);
    const float away_px = std::sqrt(dx * dx + dy * dy);
    if (away_px >= reach_px) {  // where fade_at() is 0
        std::fill_n(to, 4, 0.0f);
        return;
    }
    const glm::vec3 near = around.light_at(from_x, from_y);
    const glm::vec2 px(float(x) + 0.5f, float(y) + 0.5f);
    const float fade = fade_at(around, px, away_px, reach_px);
    const float kept = std::max(detail, 1.0f - std::min(1.0f, away_px * around.to_local));
    for (int c = 0; c < 3; ++c) {
        const float level = std::min(rim[c], near[c]),
                    detailed = std::min(to[c] / std::max(near[c], 1e-12f), brightest_detail);
        to[c] = fade * level * std::lerp(1.0f, detailed, kept);
    }
    to[3] *= fade;
}

// A galaxy beyond the frame is the galaxy itself, turned in its disk's plane (INCLINED 5).
struct TurnedGalaxy {
    GalaxyBody body;          // in the picture's texels
    Image share;              // of the light that is its own; empty: all
    float outline_px = 0.0f;  // radius in its plane beyond which there is nothing
};

TurnedGalaxy turned_galaxy(const Image& picture, const StructureParams& structure) {
    constexpr float farthest = 1.3f;  // of what is seen along the major axis
    const Image light = made_by_pixel(picture, 3, [](const float* from, float* to) {
        for (int c = 0; c < 3; ++c) to[c] = from[c] > 0.0f && std::isfinite(from[c]) ? from[c] : 0.0f;
    });
    TurnedGalaxy turned;
    OwnLight own = first_galaxy(light, structure);
    turned.body = make_galaxy_body({}, own.plane, {}, double(picture.width));
    turned.share = std::move(own.share);
    for (const float x : {0.0f, float(picture.width)})
        for (const float y : {0.0f, float(picture.height)})
            turned.outline_px =
                std::max(turned.outline_px, farthest * std::fabs(turned.body.in_disk(x, y, 0.0f).x));
    return turned;
}

constexpr float least_cosine_of_turns = 0.26f;

// A place of the picture as the galaxy has it that is turned by so many eighths of a whole turn.
glm::vec2 turned_place(const GalaxyBody& body, glm::vec2 px, int eighths) {
    constexpr float diagonal = 0.70710678f, least_cosine = 0.05f;
    constexpr float cosines[] = {1.0f, diagonal, 0.0f, -diagonal, -1.0f, -diagonal, 0.0f, diagonal};
    const float c = std::max(least_cosine, body.cos_i);
    const float cosine = cosines[eighths], sine = cosines[(eighths + 6) % 8];
    const glm::vec2 uv = along_and_across(body, px.x, px.y);
    return place_of(body, {cosine * uv.x - sine * uv.y / c, c * sine * uv.x + cosine * uv.y});
}

// Light of the texel at x, y beyond the picture: of the first turn that leads into it. Near the rim it is as
// bright as there, for no galaxy is the same on all sides.
void turn_texel(const TurnedGalaxy& turned, const Surroundings& around, const Image& image, std::int64_t x,
                std::int64_t y, float* to) {
    constexpr float fades_over = 0.5f, own_from = 0.7f, most_times = 3.0f;  // of the outline; of the margin
    std::fill_n(to, 4, 0.0f);
    const GalaxyBody& body = turned.body;
    const glm::vec2 px(float(x) + 0.5f, float(y) + 0.5f), uv = along_and_across(body, px.x, px.y);
    const float v = uv.y / std::max(0.05f, body.cos_i), r = std::sqrt(uv.x * uv.x + v * v);
    const float fade = std::clamp((turned.outline_px - r) / (fades_over * turned.outline_px), 0.0f, 1.0f);
    if (fade <= 0.0f) return;
    const glm::vec2 size(float(image.width), float(image.height));
    const glm::vec2 rim = glm::clamp(px, glm::vec2(0.5f), size - 0.5f);
    const float away = std::min(1.0f, glm::length(px - rim) / (own_from * around.margin_px));
    const auto light_at = [&](glm::vec2 p) {
        const glm::vec2 in = glm::clamp(p, glm::vec2(0.5f), size - 0.5f);
        return around.light_at(std::int64_t(in.x), std::int64_t(in.y));
    };
    constexpr int turns[] = {4, 2, 6, 3, 5, 1, 7};
    // Of a disk seen from its edge, only half a turn leads to what is at the same place of a line of sight.
    const std::size_t count = body.cos_i < least_cosine_of_turns ? 1 : std::size(turns);
    for (const int eighths : std::span(turns).first(count)) {
        const glm::vec2 from = turned_place(body, px, eighths);
        if (!(from.x >= 0.0f && from.y >= 0.0f && from.x < size.x && from.y < size.y)) continue;
        const float* const there = image.at(std::int64_t(from.x), std::int64_t(from.y));
        const float to_share = float(turned.share.width) / size.x;
        const float own = turned.share.pixels.empty()
                              ? 1.0f
                              : bilinear(turned.share, 0, from.x * to_share, from.y * to_share);
        const glm::vec3 near = light_at(from), at_rim = light_at(rim),
                        rim_there = light_at(turned_place(body, rim, eighths));
        for (int k = 0; k < 3; ++k) {
            const float times =
                std::clamp(at_rim[k] / std::max(rim_there[k], 1e-6f), 1.0f / most_times, most_times);
            to[k] =
                own * fade * std::lerp(times, 1.0f, away) * std::min(there[k], brightest_detail * near[k]);
        }
        to[3] = own * fade;
        return;
    }
}

Image continued(const Texture& texture, std::int64_t margin_px, const StructureParams& structure) {
    const Image& image = texture.image;
    const bool disk = structure.kind == StructureKind::disk;
    const float detail = std::min(1.0f, float(structure.clumps));
    const Surroundings around = surroundings_of(image, margin_px, !disk && detail == 0.0f);
    const TurnedGalaxy galaxy = disk ? turned_galaxy(image, structure) : TurnedGalaxy();
    Image out = unfilled_image(image.width + 2 * margin_px, image.height + 2 * margin_px, image.channels);
    for_each_pixel(out, [&](std::int64_t column, std::int64_t row) {
        const std::int64_t x = column - margin_px, y = row - margin_px;
        const bool inside = beyond(x, image.width) == 0 && beyond(y, image.height) == 0;
        float* const to = out.at(column, row);
        std::copy_n(image.at(mirrored(x, image.width), mirrored(y, image.height)), image.channels, to);
        if (texture.alpha_from_light) to[3] = 1.0f;
        if (inside) return;
        if (disk)
            turn_texel(galaxy, around, image, x, y, to);
        else
            continue_texel(around, image, x, y, detail, to);
    });
    return out;
}

glm::dvec2 add_margin(TexturedMesh& mesh, const StructureParams& structure) {
    Texture& texture = mesh.textures.front();
    const auto width = double(texture.image.width), height = double(texture.image.height);
    const std::int64_t margin_px = std::llround(structure.margin * width);
    if (margin_px == 0) return {1.0, 1.0};
    texture.image = continued(texture, margin_px, structure);
    texture.alpha_from_light = false;
    const glm::dvec2 times(double(texture.image.width) / width, double(texture.image.height) / height);
    for (glm::vec3& p : mesh.mesh.positions) p = {float(p.x * times.x), p.y, float(p.z * times.y)};
    if (mesh.camera) mesh.camera = widened(*mesh.camera, times);
    if (mesh.camera) apply_camera_uv(mesh.mesh, *mesh.camera);
    return times;
}

}  // namespace

Image mirrored_margin(const Image& image, double margin) {
    const auto margin_px = std::llround(double(image.width) * margin / (1.0 + 2.0 * margin));
    const std::int64_t width = image.width - 2 * margin_px, height = image.height - 2 * margin_px;
    Image out = unfilled_image(image.width, image.height, image.channels);
    for_each_pixel(out, [&](std::int64_t x, std::int64_t y) {
        std::copy_n(
            image.at(margin_px + mirrored(x - margin_px, width), margin_px + mirrored(y - margin_px, height)),
            image.channels, out.at(x, y));
    });
    return out;
}

std::vector<glm::dvec2> add_margins(std::vector<TexturedMesh>& meshes, const StructureParams& structure,
                                    const std::string& layer_name) {
    std::vector<glm::dvec2> times(meshes.size(), glm::dvec2(1.0));
    if (structure.margin <= 0.0) return times;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i].mesh.name == "plane")
            times[i] = add_margin(meshes[i], structure);
        else
            log_warning(fmt::format("layer '{}': source.structure.margin acts on planes only, not on '{}'",
                                    layer_name, meshes[i].mesh.name));
    }
    return times;
}

}  // namespace astrosplat
