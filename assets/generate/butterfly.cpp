// The demo nebula: an hourglass of two nested, folded sheets of gas, each with a picture of bright filaments
// and one of thin veils, a dark torus around the waist and a small cluster of stars inside it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "assets.h"
#include "canvas.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "mesh_file.h"
#include "noise.h"
#include "splat_rows.h"

namespace astrosplat::assets {
namespace {

constexpr int picture_px = 1024;

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
    return make_sheet(80, 104, true, [&](float turn, float along) {
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

Canvas sheet_picture(const Sheet& sheet, bool bright, glm::vec3 (*color)(const Around&, float)) {
    Canvas canvas = make_canvas(picture_px, picture_px);
    paint(canvas, [&](float u, float v) {
        const Around a = around(u, v);
        const float mottle = fbm(grain(a, 2.4f, 3.0f), sheet.seed + 111, 4, 0.6f);
        const float light = bright ? 0.60f * filaments(a, sheet.seed) : 0.30f * veil(a, sheet.seed);
        return glm::vec4(asinh_curve(color(a, mottle) * (light * extent(a, sheet.seed + 121)), 0.35f, 2.2f),
                         1.0f);
    });
    return canvas;
}

SheetMesh torus_mesh() {
    return make_sheet(72, 24, true, [](float turn, float around_tube) {
        const Around a = around(turn, 0.5f), tube = around(around_tube, 0.5f);
        const float lumps =
            1.0f + 0.35f * fbm(glm::vec3(a.cosine * 2.0f, a.sine * 2.0f, 1.5f * tube.cosine), 1301, 3);
        const float radius = 0.66f + 0.16f * lumps * tube.cosine;
        return SheetPoint{{0.10f * lumps * tube.sine, radius * a.cosine + waist_place.y, radius * a.sine},
                          {turn, around_tube}};
    });
}

Canvas torus_picture() {
    Canvas canvas = make_canvas(512, 192);
    paint(canvas, [](float u, float v) {
        const Around a = around(u, 0.5f), tube = around(v, 0.5f);
        const glm::vec3 p(a.cosine * 3.5f + tube.cosine, a.sine * 3.5f + tube.sine, 1.2f * tube.sine);
        const float wisps = ridged(p, 1311, 6, 0.6f), clumps = fbm(p * 0.7f, 1321, 5, 0.6f);
        const float depth = 2.4f * smoothstep(0.25f, 0.8f, wisps) * shared::as_exp(2.6f * clumps);
        return glm::vec4(0.045f, 0.018f, 0.008f, 1.0f - shared::as_exp(-depth));
    });
    return canvas;
}

// Stars crowd towards the middle; luminosity is a power law, shown as size and opacity. The last is the dying
// star.
void save_cluster(const std::filesystem::path& file) {
    std::vector<SplatRow> rows;
    for (unsigned i = 0; i < 2000; ++i) {
        const glm::vec3 direction(normal(1401, i, 1), normal(1401, i, 2), normal(1401, i, 3));
        const float spread = 0.05f + 1.1f * shared::as_pow(uniform(1401, i, 4), 1.6f);
        const float light = std::min(30.0f, shared::as_pow(std::max(1e-5f, uniform(1401, i, 5)), -0.8f));
        const glm::vec3 tint = blend(glm::vec3(0.66f, 0.80f, 1.0f), glm::vec3(1.0f, 0.78f, 0.55f),
                                     1.4f * uniform(1401, i, 6) - 0.4f);
        rows.push_back({waist_place + direction * spread, tint, std::min(1.0f, 0.35f + 0.08f * light),
                        0.011f * std::sqrt(std::sqrt(light))});
    }
    rows.push_back({waist_place, glm::vec3(0.80f, 0.92f, 1.0f), 1.0f, 0.26f});
    rows.push_back({waist_place, glm::vec3(0.70f, 0.88f, 1.0f), 0.22f, 1.0f});  // its glow
    save_ply(rows, file, "a star cluster");
}

}  // namespace

void make_butterfly(const std::filesystem::path& folder) {
    save_obj(sheet_mesh(outer), folder / "meshes/nebula_outer.obj",
             "outer sheet of an hourglass along x, 10 long");
    save_obj(sheet_mesh(inner), folder / "meshes/nebula_inner.obj",
             "inner sheet of an hourglass along x, 8 long");
    save_obj(torus_mesh(), folder / "meshes/nebula_torus.obj", "a lumpy torus around x");
    save_jpeg(sheet_picture(outer, true, outer_color), folder / "textures/nebula_outer_filaments.jpg", 86);
    save_jpeg(sheet_picture(outer, false, outer_color), folder / "textures/nebula_outer_veil.jpg", 86);
    save_jpeg(sheet_picture(inner, true, inner_color), folder / "textures/nebula_inner_filaments.jpg", 86);
    save_jpeg(sheet_picture(inner, false, inner_color), folder / "textures/nebula_inner_veil.jpg", 86);
    save_png(torus_picture(), folder / "textures/nebula_torus.png", 4);
    save_cluster(folder / "meshes/nebula_cluster.ply");
}

}  // namespace astrosplat::assets
