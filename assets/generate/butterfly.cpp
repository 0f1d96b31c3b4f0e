// The demo nebula as a telescope would see it: an hourglass of two nested, folded sheets of gas, each laid
// out with filaments and veils and seen through, a dark ring around the waist, the dying star, and field
// stars.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "assets.h"
#include "canvas.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "mesh_file.h"
#include "noise.h"

namespace astrosplat::assets {
namespace {

constexpr int width_px = 1920, height_px = 1200;
constexpr float px_per_unit = 152.0f;
constexpr int sheet_px = 2048;  // of a sheet's light, once around by its length
constexpr int grid = 1024;      // places of a sheet, along each side
constexpr int samples = 6;      // along each side of a grid's cell

struct Sheet {
    float length;  // half, scene units
    float girth;   // of the lobes, scene units
    float waist;   // scene units
    float folds;   // relative height of the folds
    unsigned seed;
};

constexpr glm::vec3 waist_place(0.0f, -0.12f, 0.0f);  // where the bent axis crosses x = 0
constexpr Sheet outer = {5.0f, 2.15f, 0.34f, 0.30f, 1100};
constexpr Sheet inner = {4.1f, 1.35f, 0.20f, 0.38f, 1200};

// A place on a sheet without its folds: direction around the axis, and s = -1..1 along it.
struct Around {
    float cosine, sine, s;
};

Around around(float turn, float along) {
    const double angle = 2.0 * real::pi * static_cast<double>(turn);
    return {static_cast<float>(real::cos(angle)), static_cast<float>(real::sin(angle)), 2.0f * along - 1.0f};
}

// Where noise is sampled: `across` cells per radius around, `along` cells per half length. Has no seam.
glm::vec3 grain(const Around& a, float across, float along) {
    return {a.cosine * across, a.sine * across, a.s * along};
}

// Lobes open from the waist, are widest at three quarters and draw in again.
float lobe(float s) {
    const float a = std::fabs(s);
    const float open =
        static_cast<float>(real::sin(real::pi * 0.5 * static_cast<double>(std::min(1.0f, a / 0.78f))));
    return shared::as_pow(open, 1.25f) * (1.0f - 0.30f * smoothstep(0.74f, 1.0f, a)) *
           (s < 0.0f ? 1.08f : 0.92f);
}

SheetMesh sheet_mesh(const Sheet& sheet) {
    return make_sheet(grid, grid, true, [&](float turn, float along) {
        const Around a = around(turn, along);
        const float pleats = ridged(grain(a, 1.7f, 1.1f), sheet.seed + 1, 3) - 0.35f;
        const float dents = fbm(grain(a, 1.1f, 2.2f), sheet.seed + 11, 3);
        const float ripples = fbm(grain(a, 3.2f, 7.0f), sheet.seed + 21, 3);
        const float fold = 1.0f + sheet.folds * (0.9f * pleats + 1.1f * dents + 0.35f * ripples);
        const float radius = sheet.waist + sheet.girth * lobe(a.s) * std::max(0.25f, fold);
        // The axis is bent, and the ends are ragged.
        const float x = sheet.length * a.s * (1.0f + 0.10f * fbm(grain(a, 1.3f, 1.0f), sheet.seed + 31, 2));
        const glm::vec2 bend(0.35f * a.s * a.s + waist_place.y, 0.30f * a.s * std::fabs(a.s));
        return SheetPoint{{x, radius * a.cosine + bend.x, radius * a.sine + bend.y}, {turn, along}};
    });
}

// Bright near the waist, gone before the sheet's end, whose outline is torn by noise.
float extent(const Around& a, unsigned seed) {
    const float torn = std::fabs(a.s) + 0.26f * fbm(grain(a, 3.0f, 3.0f), seed, 4, 0.6f);
    const float regions = shared::as_exp(1.7f * fbm(grain(a, 1.2f, 1.6f), seed + 5, 3));
    return regions * (1.0f - smoothstep(0.40f, 0.92f, torn)) *
           (0.35f + 0.65f * shared::as_exp(-1.6f * std::fabs(a.s)));
}

// Filaments run outwards from the waist, knotted by shorter noise and crossed by ripples of gas piled up.
float filaments(const Around& a, unsigned seed) {
    Around b = a;
    b.s += 0.10f * fbm(grain(a, 2.0f, 3.0f), seed + 41, 4);
    const float bend = 0.30f * fbm(grain(a, 1.5f, 2.5f), seed + 51, 4);
    b.cosine += bend;
    b.sine -= bend;
    const float rays = ridged(grain(b, 4.2f, 2.6f), seed + 61, 6, 0.62f);
    const float cells = ridged(grain(b, 7.5f, 9.0f), seed + 71, 5, 0.6f);
    const float knots = shared::as_exp(2.4f * fbm(grain(b, 5.0f, 6.0f), seed + 81, 6, 0.62f));
    const float both = 0.75f * smoothstep(0.25f, 0.85f, rays) + 0.55f * smoothstep(0.3f, 0.85f, cells);
    return both * knots;
}

float veil(const Around& a, unsigned seed) {
    const float wide = shared::as_exp(1.8f * fbm(grain(a, 1.8f, 2.2f), seed + 91, 6, 0.55f));
    const float streaks = 0.6f + 0.8f * ridged(grain(a, 5.0f, 1.6f), seed + 101, 5, 0.6f);
    return wide * streaks;
}

glm::vec3 blend(glm::vec3 a, glm::vec3 b, float t) { return shared::mix(a, b, std::clamp(t, 0.0f, 1.0f)); }

// Nitrogen red at the outer sheet's far ends, gold towards the waist; `mottle` varies it from place to place.
glm::vec3 outer_color(const Around& a, float mottle) {
    const glm::vec3 far = blend(glm::vec3(0.85f, 0.10f, 0.13f), glm::vec3(1.0f, 0.30f, 0.10f), 0.5f + mottle);
    return blend(glm::vec3(1.0f, 0.62f, 0.26f), far, 1.7f * std::fabs(a.s) + 0.5f * mottle);
}

// Oxygen teal inside, whiter and bluer near the hot star.
glm::vec3 inner_color(const Around& a, float mottle) {
    const glm::vec3 far =
        blend(glm::vec3(0.10f, 0.62f, 0.66f), glm::vec3(0.22f, 0.42f, 0.95f), 0.4f + mottle);
    return blend(glm::vec3(0.62f, 0.90f, 0.95f), far, 1.6f * std::fabs(a.s) + 0.4f * mottle);
}

// Light of a sheet per area.
Canvas sheet_light(const Sheet& sheet, glm::vec3 (*color)(const Around&, float)) {
    Canvas canvas = make_canvas(sheet_px, sheet_px);
    paint(canvas, [&](float u, float v) {
        const Around a = around(u, v);
        const float mottle = fbm(grain(a, 2.4f, 3.0f), sheet.seed + 111, 4, 0.6f);
        const float light = 0.60f * filaments(a, sheet.seed) + 0.20f * veil(a, sheet.seed);
        return glm::vec4(color(a, mottle) * (light * extent(a, sheet.seed + 121)), 1.0f);
    });
    return canvas;
}

// The nebula leans away from the viewer and lies obliquely in the picture.
glm::vec3 turned(glm::vec3 p) {
    const float lean = 0.30f, roll = 0.24f;
    const auto cosine = [](float a) { return static_cast<float>(real::cos(static_cast<double>(a))); };
    const auto sine = [](float a) { return static_cast<float>(real::sin(static_cast<double>(a))); };
    const glm::vec3 q(p.x * cosine(lean) - p.z * sine(lean), p.y, p.x * sine(lean) + p.z * cosine(lean));
    return {q.x * cosine(roll) - q.y * sine(roll), q.x * sine(roll) + q.y * cosine(roll), q.z};
}

glm::vec2 on_picture(glm::vec3 p) {
    return {0.5f * static_cast<float>(width_px) + px_per_unit * p.x,
            0.5f * static_cast<float>(height_px) - px_per_unit * p.y};
}

// Light of the half behind the waist and of the half before it, which the ring does not dim.
struct SeenGas {
    Canvas behind = make_canvas(width_px, height_px), before = make_canvas(width_px, height_px);
};

void add_light(Canvas& canvas, glm::vec2 place_px, glm::vec4 light) {
    const glm::vec2 at = place_px - 0.5f;
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    if (x < 0 || y < 0 || x + 1 >= canvas.width || y + 1 >= canvas.height) return;
    const float s = at.x - static_cast<float>(x), t = at.y - static_cast<float>(y);
    canvas.at(x, y) += (1.0f - s) * (1.0f - t) * light;
    canvas.at(x + 1, y) += s * (1.0f - t) * light;
    canvas.at(x, y + 1) += (1.0f - s) * t * light;
    canvas.at(x + 1, y + 1) += s * t * light;
}

// A sheet is optically thin: where it folds or turns its edge to us, its light adds up.
void add_sheet(const SheetMesh& mesh, const Canvas& light, SeenGas& gas) {
    const auto point = [&](int column, int row) {
        return turned(mesh.points[static_cast<std::size_t>(row * (mesh.columns + 1) + column)].position);
    };
    const auto texel = [](int cell, float share) {
        return static_cast<int>((static_cast<float>(cell) + share) * static_cast<float>(sheet_px / grid));
    };
    for (int row = 0; row < mesh.rows; ++row) {
        for (int column = 0; column < mesh.columns; ++column) {
            const glm::vec3 a = point(column, row), b = point(column + 1, row), c = point(column, row + 1),
                            d = point(column + 1, row + 1);
            const float area_px = glm::length(glm::cross(b - a, c - a)) * px_per_unit * px_per_unit;
            for (int k = 0; k < samples * samples; ++k) {
                const float s = (static_cast<float>(k % samples) + 0.5f) / static_cast<float>(samples),
                            t = (static_cast<float>(k / samples) + 0.5f) / static_cast<float>(samples);
                const glm::vec3 p = (1.0f - t) * ((1.0f - s) * a + s * b) + t * ((1.0f - s) * c + s * d);
                const glm::vec4 here = light.at(texel(column, s), sheet_px - 1 - texel(row, t));
                add_light(p.z < 0.0f ? gas.behind : gas.before, on_picture(p),
                          here * (area_px / static_cast<float>(samples * samples)));
            }
        }
    }
}

// Optical depth of the ring's nearer half, a torn band across the waist.
float ring_depth(glm::vec2 p) {
    const glm::vec3 across = turned({0.0f, 1.0f, 0.0f}), along = turned({1.0f, 0.0f, 0.0f});
    const glm::vec2 at = p - glm::vec2(turned(waist_place));
    const float y = at.x * across.x + at.y * across.y, x = at.x * along.x + at.y * along.y;
    const float bow = x - 0.13f * (1.0f - y * y / 0.75f);  // the ring leans towards us
    const glm::vec2 grain_place(4.0f * bow + 9.0f, 3.0f * y);
    const float torn = 0.07f * fbm(grain_place, 1311, 5, 0.6f);
    const float band = shared::as_exp(-shared::as_pow(std::fabs(bow + torn) / 0.10f, 2.0f)) *
                       (1.0f - smoothstep(0.36f, 0.58f, std::fabs(y)));
    return band * (0.7f + 2.6f * smoothstep(0.2f, 0.8f, ridged(grain_place, 1321, 6, 0.6f)));
}

// Luminosity is a power law; a few have the colours of giants.
void add_field_stars(Canvas& canvas, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        const glm::vec2 place(uniform(1401, i, 1) * width_px, uniform(1401, i, 2) * height_px);
        const float light = std::min(60.0f, shared::as_pow(std::max(1e-5f, uniform(1401, i, 3)), -1.1f));
        const glm::vec3 tint = blend(glm::vec3(0.66f, 0.80f, 1.0f), glm::vec3(1.0f, 0.72f, 0.45f),
                                     1.5f * uniform(1401, i, 4) - 0.4f);
        add_glow(canvas, place, tint * (0.5f * light), 1.05f);
    }
}

Canvas telescope_picture() {
    SeenGas gas;
    add_sheet(sheet_mesh(outer), sheet_light(outer, outer_color), gas);
    add_sheet(sheet_mesh(inner), sheet_light(inner, inner_color), gas);
    const glm::vec2 star = on_picture(turned(waist_place));
    add_glow(gas.behind, star, glm::vec3(2600.0f, 2800.0f, 3000.0f), 16.0f);
    add_glow(gas.behind, star, glm::vec3(900.0f, 640.0f, 480.0f), 46.0f);
    Canvas picture = make_canvas(width_px, height_px);
    add_field_stars(picture, 420);
    add_glow(picture, star, glm::vec3(60.0f, 75.0f, 90.0f), 1.3f);
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
            const glm::vec2 p(
                (static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(width_px)) / px_per_unit,
                (0.5f * static_cast<float>(height_px) - static_cast<float>(y) - 0.5f) / px_per_unit);
            const float depth = ring_depth(p);
            const glm::vec3 dimmed(shared::as_exp(-0.8f * depth), shared::as_exp(-depth),
                                   shared::as_exp(-1.35f * depth));
            const glm::vec3 light = glm::vec3(gas.behind.at(x, y)) * dimmed + glm::vec3(gas.before.at(x, y)) +
                                    glm::vec3(picture.at(x, y));
            picture.at(x, y) = glm::vec4(asinh_curve(light, 0.30f, 6.0f), 1.0f);
        }
    }
    return picture;
}

}  // namespace

void make_butterfly(const std::filesystem::path& folder) {
    save_jpeg(telescope_picture(), folder / "textures/butterfly.jpg", 90);
}

}  // namespace astrosplat::assets
