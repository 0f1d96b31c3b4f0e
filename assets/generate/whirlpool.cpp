// The demo galaxy's pictures: starlight, dust, glowing hydrogen and how thick the disk is, plus a slightly
// warped disk to put them on. Each picture is painted from the densities in spiral.h and strewn with single
// stars and clusters.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "assets.h"
#include "canvas.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "mesh_file.h"
#include "noise.h"
#include "spiral.h"
#include "splat_rows.h"

namespace astrosplat::assets {
namespace {

constexpr int picture_px = 2048;
constexpr glm::vec3 old_color(1.0f, 0.75f, 0.46f);
constexpr glm::vec3 disk_color(1.0f, 0.79f, 0.56f);
constexpr glm::vec3 young_color(0.36f, 0.58f, 1.0f);

glm::vec2 on_disk(float u, float v) { return {2.0f * u - 1.0f, 2.0f * v - 1.0f}; }

glm::vec2 in_pixels(glm::vec2 p) { return glm::vec2(p.x + 1.0f, 1.0f - p.y) * (0.5f * picture_px); }

// Fades to nothing before the picture's border, irregularly.
float rim(glm::vec2 p) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y) + 0.07f * fbm(p * 3.0f, 301, 4);
    return 1.0f - smoothstep(0.66f, 0.97f, r);
}

glm::vec3 extinct(glm::vec3 light, float depth) {
    return {light.x * shared::as_exp(-0.72f * depth), light.y * shared::as_exp(-1.0f * depth),
            light.z * shared::as_exp(-1.35f * depth)};
}

// The old disk and the bulge: smooth and warm.
glm::vec3 old_light(glm::vec2 p, const DiskPlace& place) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float mottle = 1.0f + 0.25f * fbm(p * 14.0f, 311, 5, 0.65f);
    const float disk = 0.60f * shared::as_exp(-r / 0.195f) * (0.45f + 0.8f * place.broad) * mottle;
    const float bulge = 12.0f * shared::as_exp(-std::sqrt(r / 0.0060f));
    return disk_color * disk + old_color * bulge;
}

// The arms: blue and torn.
glm::vec3 young_light(glm::vec2 p, const DiskPlace& place) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const float streaks = shared::as_exp(1.25f * along_spiral(place, 18.0f, 40, 3.5f, 321, false));
    const float patches = shared::as_exp(2.1f * fbm(p * 15.0f, 331, 6, 0.70f));
    const float reach = shared::as_exp(-r / 0.46f) * smoothstep(0.05f, 0.20f, r);
    return young_color * (reach * patches * (1.15f * place.young * streaks + 0.05f * place.broad));
}

// Calls each(place, random index) for points strewn with probability chance(disk place) <= 1.
template <class Chance, class Each>
void strew(unsigned seed, unsigned trials, Chance chance, Each each) {
    for (unsigned i = 0; i < trials; ++i) {
        const glm::vec2 p = on_disk(uniform(seed, i, 1), uniform(seed, i, 2));
        if (p.x * p.x + p.y * p.y > 0.94f) continue;
        const DiskPlace place = disk_place(p);
        if (uniform(seed, i, 3) < chance(p, place)) each(p, place, i);
    }
}

// Power law: N(> flux) ~ flux^-slope, from 1 up to `most`.
float power_law(float u, float slope, float most) {
    return std::min(most, shared::as_pow(std::max(u, 1e-6f), -1.0f / slope));
}

void add_field_stars(Canvas& canvas) {
    const auto chance = [](glm::vec2 p, const DiskPlace& place) {
        return rim(p) * shared::as_exp(-place.r / 0.33f) * (0.25f + 0.75f * std::min(1.0f, place.broad));
    };
    strew(401, 420000, chance, [&](glm::vec2 p, const DiskPlace& place, unsigned i) {
        const float flux = 0.028f * power_law(uniform(401, i, 4), 1.5f, 6.0f) * (0.5f + place.r);
        const float warmth = std::clamp(uniform(401, i, 5) + 0.25f - place.young * 0.7f, 0.0f, 1.0f);
        add_glow(canvas, in_pixels(p), flux * glm::vec3(shared::mix(young_color, old_color, warmth)), 0.62f);
    });
}

// A picture of `light` on black, with `baked` of the dust's depth: the part that lies before these stars
// whichever way one looks.
Canvas light_picture(int size_px, const std::function<glm::vec3(glm::vec2, const DiskPlace&)>& light,
                     float baked) {
    Canvas canvas = make_canvas(size_px, size_px);
    paint(canvas, [&](float u, float v) {
        const glm::vec2 p = on_disk(u, v);
        const DiskPlace place = disk_place(p);
        return glm::vec4(extinct(light(p, place) * rim(p), baked * dust_depth(p, place)), 1.0f);
    });
    return canvas;
}

void develop(Canvas& canvas, float softening, float white) {
    for (glm::vec4& pixel : canvas.pixels)
        pixel = glm::vec4(asinh_curve(glm::vec3(pixel), softening, white), 1.0f);
}

Canvas disk_picture() {
    Canvas canvas = light_picture(1024, old_light, 0.4f);
    develop(canvas, 0.17f, 3.4f);
    return canvas;
}

Canvas arms_picture() {
    Canvas canvas = light_picture(picture_px, young_light, 0.55f);
    add_field_stars(canvas);
    develop(canvas, 0.17f, 3.0f);
    return canvas;
}

// Height of the disk's middle plane, scene units: its rim bends up on one side and down on the other, as most
// real disks do.
float warp(glm::vec2 p) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const double angle =
        real::atan2(static_cast<double>(p.y), static_cast<double>(p.x)) + 2.2 * static_cast<double>(r);
    return 0.17f * smoothstep(0.45f, 1.05f, r) * static_cast<float>(real::sin(angle)) +
           0.02f * noise(3.0f * p, 611);
}

SheetMesh disk_mesh() {
    return make_sheet(96, 28, true, [](float turn, float out) {
        const double angle = 2.0 * real::pi * static_cast<double>(turn);
        const glm::vec2 p = std::sqrt(out) * glm::vec2(static_cast<float>(real::cos(angle)),
                                                       static_cast<float>(real::sin(angle)));
        return SheetPoint{{5.0f * p.x, warp(p), -5.0f * p.y}, 0.5f + 0.5f * p};
    });
}

// Calls each(place, light, tint, random index) for the bright young stars. Luminosity is a power law.
template <class Each>
void strew_clusters(Each each) {
    const auto chance = [](glm::vec2 p, const DiskPlace& place) {
        const float lumps = smoothstep(-0.2f, 0.6f, fbm(p * 13.0f, 411, 4, 0.6f));
        return rim(p) * place.young * lumps * smoothstep(0.05f, 0.2f, place.r);
    };
    strew(421, 330000, chance, [&](glm::vec2 p, const DiskPlace&, unsigned i) {
        each(p, power_law(uniform(421, i, 4), 1.15f, 40.0f),
             glm::vec3(shared::mix(young_color, glm::vec3(0.95f, 0.95f, 1.0f), uniform(421, i, 5))), i);
    });
}

// Single bright stars and clusters as a splat file: in a picture they would be drawn out into columns through
// the thickness of the layer. Luminosity is a power law, shown as size and opacity.
void save_clusters(const std::filesystem::path& file) {
    std::vector<SplatRow> rows;
    strew_clusters([&](glm::vec2 p, float light, glm::vec3 tint, unsigned i) {
        const glm::vec3 place(5.0f * p.x, warp(p) + 0.035f * normal(421, i, 6), -5.0f * p.y);
        rows.push_back(
            {place, tint, std::min(1.0f, 0.30f + 0.06f * light), 0.011f * std::sqrt(std::sqrt(light))});
    });
    save_ply(rows, file, "young star clusters");
}

Canvas dust_picture() {
    Canvas canvas = make_canvas(1536, 1536);
    paint(canvas, [](float u, float v) {
        const glm::vec2 p = on_disk(u, v);
        const float alpha = 1.0f - shared::as_exp(-dust_depth(p, disk_place(p)) * rim(p));
        return glm::vec4(0.030f, 0.015f, 0.008f, alpha < 0.012f ? 0.0f : alpha);
    });
    return canvas;
}

// One glowing region: a loose heap of small glows, brightest near its middle.
void add_region(Canvas& canvas, glm::vec2 p, float flux, unsigned i) {
    const float size = 0.0017f * shared::as_pow(flux, 0.40f);  // disk radii
    const unsigned lumps = 2u + static_cast<unsigned>(2.2f * std::sqrt(flux));
    for (unsigned k = 0; k < lumps; ++k) {
        const unsigned id = i * 64u + k;
        const glm::vec2 offset = 1.1f * size * glm::vec2(normal(511, id, 1), normal(511, id, 2));
        const float share = power_law(uniform(511, id, 5), 1.2f, 8.0f) / (2.2f * static_cast<float>(lumps));
        const float sigma = std::max(0.7f, size * picture_px * (0.06f + 0.30f * uniform(511, id, 6)));
        const float heat = uniform(511, id, 7);
        const glm::vec3 color =
            shared::mix(glm::vec3(1.0f, 0.10f, 0.20f), glm::vec3(1.0f, 0.36f, 0.50f), heat * heat);
        add_glow(canvas, in_pixels(p + offset), 3.6f * flux * share * color, sigma);
    }
    if (flux > 14.0f)  // oxygen shows in the hot middle of the largest
        add_glow(canvas, in_pixels(p), 0.7f * flux * glm::vec3(0.45f, 0.8f, 0.95f),
                 std::max(0.8f, size * 0.12f * picture_px));
}

// Calls each(place, random index) for the glowing regions of the arms.
template <class Each>
void strew_regions(Each each) {
    const auto chance = [](glm::vec2 p, const DiskPlace& place) {
        const float lumps = smoothstep(-0.05f, 0.5f, fbm(p * 12.0f, 541, 4, 0.7f));
        return 0.9f * place.ridge * place.ridge * lumps * smoothstep(0.07f, 0.2f, place.r);
    };
    strew(501, 190000, chance, [&](glm::vec2 p, const DiskPlace&, unsigned i) { each(p, i); });
}

Canvas nebulae_picture() {
    Canvas canvas = make_canvas(picture_px, picture_px);
    paint(canvas, [](float u, float v) {
        const glm::vec2 p = on_disk(u, v);
        const DiskPlace place = disk_place(p);
        const float threads = ridged(p * 17.0f, 521, 6, 0.6f);
        const float patches = shared::as_exp(3.0f * fbm(p * 10.0f, 531, 5, 0.6f));
        const float glow =
            0.022f * place.ridge * patches * (0.3f + threads) * smoothstep(0.06f, 0.2f, place.r);
        return glm::vec4(glow * glm::vec3(1.0f, 0.18f, 0.28f), 1.0f);
    });
    strew_regions([&](glm::vec2 p, unsigned i) {
        add_region(canvas, p, 1.3f * power_law(uniform(501, i, 4), 1.05f, 26.0f), i);
    });
    Canvas out = make_canvas(picture_px, picture_px);
    paint(out, [&](float u, float v) {
        const glm::vec2 p = on_disk(u, v);
        const glm::vec4& c =
            canvas.at(static_cast<int>(u * picture_px), static_cast<int>((1.0f - v) * picture_px));
        const float wisps = shared::as_exp(1.6f * fbm(p * 70.0f, 551, 4, 0.65f));
        return glm::vec4(asinh_curve(glm::vec3(c) * (rim(p) * wisps), 0.22f, 2.6f), 1.0f);
    });
    return out;
}

// Of stars of our own galaxy before it: few bright ones, many faint.
void add_foreground_stars(Canvas& canvas, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        const glm::vec2 place(uniform(431, i, 1) * static_cast<float>(canvas.width),
                              uniform(431, i, 2) * static_cast<float>(canvas.height));
        const float warmth = uniform(431, i, 4);
        const glm::vec3 tint(0.75f + 0.25f * warmth, 0.9f, 1.1f - 0.5f * warmth);
        add_glow(canvas, place, 1.2f * power_law(uniform(431, i, 3), 0.9f, 60.0f) * tint, 0.95f);
    }
}

// All of it as a telescope would see it from above, on one flat picture, cut to 4:3.
Canvas telescope_picture() {
    Canvas canvas = make_canvas(picture_px, picture_px);
    add_field_stars(canvas);
    strew_clusters([&](glm::vec2 p, float light, glm::vec3 tint, unsigned) {
        add_glow(canvas, in_pixels(p), 0.55f * light * tint, 0.85f);
    });
    strew_regions([&](glm::vec2 p, unsigned i) {
        add_region(canvas, p, 0.8f * power_law(uniform(501, i, 4), 1.05f, 26.0f), i);
    });
    Canvas out = make_canvas(picture_px, 3 * picture_px / 4);
    const int top = (picture_px - out.height) / 2;
    paint(out, [&](float u, float v) {
        const glm::vec2 p(2.0f * u - 1.0f, 1.5f * v - 0.75f);
        const DiskPlace place = disk_place(p);
        const glm::vec3 points(
            canvas.at(static_cast<int>(u * picture_px),
                      top + static_cast<int>((1.0f - v) * static_cast<float>(out.height))));
        const float wisps = shared::as_exp(1.2f * fbm(p * 70.0f, 551, 4, 0.65f));
        const glm::vec3 glow = 0.02f * place.ridge * wisps * glm::vec3(1.0f, 0.18f, 0.28f);
        const glm::vec3 light = (old_light(p, place) + young_light(p, place) + glow) * rim(p);
        const float depth = dust_depth(p, place) * rim(p);
        return glm::vec4(extinct(light, depth) + extinct(points, 0.4f * depth), 1.0f);
    });
    add_foreground_stars(out, 260);
    develop(out, 0.28f, 3.0f);
    return out;
}

// Red: the bulge, as high as it is wide. Green: the inner disk. Blue: the thin outer disk.
// `height` of its middle, in widths.
Canvas thickness_picture(float height) {
    Canvas canvas = make_canvas(512, static_cast<int>(512.0f * height));
    paint(canvas, [&](float u, float v) {
        const glm::vec2 p = on_disk(u, 0.5f + (v - 0.5f) * height);
        const float r = std::sqrt(p.x * p.x + p.y * p.y) * (1.0f + 0.1f * fbm(p * 4.0f, 601, 3));
        const float bulge = 1.0f - smoothstep(0.02f, 0.24f, r), outer = smoothstep(0.25f, 0.85f, r);
        return glm::vec4(bulge, (1.0f - bulge) * (1.0f - outer), (1.0f - bulge) * outer, 1.0f);
    });
    return canvas;
}

// The bulge alone, for a layer of its own: brightness is also its height. The picture's half width is a
// quarter of the disk's.
Canvas bulge_picture() {
    Canvas canvas = make_canvas(256, 256);
    paint(canvas, [](float u, float v) {
        const glm::vec2 p = on_disk(u, v);
        const float r = std::sqrt(p.x * p.x + p.y * p.y);
        const float light =
            shared::as_exp(-3.2f * std::sqrt(r * r + 0.02f)) * (1.0f - smoothstep(0.45f, 1.0f, r));
        return glm::vec4(old_color * light, 1.0f);
    });
    return canvas;
}

}  // namespace

void make_whirlpool(const std::filesystem::path& folder) {
    save_jpeg(disk_picture(), folder / "textures/whirlpool_disk.jpg", 92);
    save_jpeg(arms_picture(), folder / "textures/whirlpool_arms.jpg", 88);
    save_png(dust_picture(), folder / "textures/whirlpool_dust.png", 4);
    save_jpeg(nebulae_picture(), folder / "textures/whirlpool_nebulae.jpg", 88);
    save_png(bulge_picture(), folder / "textures/whirlpool_bulge.png", 3);
    save_png(thickness_picture(1.0f), folder / "textures/whirlpool_thickness.png", 3);
    save_obj(disk_mesh(), folder / "meshes/whirlpool_disk.obj", "a gently warped disk, radius 5");
    save_clusters(folder / "meshes/whirlpool_clusters.ply");
}

void make_spiral(const std::filesystem::path& folder) {
    save_jpeg(telescope_picture(), folder / "textures/spiral.jpg", 90);
    save_png(thickness_picture(0.75f), folder / "textures/spiral_thickness.png", 3);
}

}  // namespace astrosplat::assets
