// The arms are logarithmic spirals, written down one by one so that no two are alike, and bent by noise.
#include "spiral.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/real.h"
#include "core/shared_maths.h"
#include "noise.h"

namespace astrosplat::assets {
namespace {

struct Arm {
    float angle_deg;  // where it begins
    float pitch_deg;
    float from, to;  // radii
    float strength;
    float width;  // of the crest at radius 1/2
    unsigned seed;
};

// Two main arms; each forks, and three stray segments lie between them.
constexpr std::array<Arm, 8> arms = {{
    {20.0f, 17.5f, 0.085f, 0.93f, 1.00f, 0.046f, 101},
    {207.0f, 19.0f, 0.095f, 0.86f, 0.92f, 0.042f, 102},
    {268.0f, 26.0f, 0.34f, 0.90f, 0.62f, 0.034f, 103},
    {76.0f, 13.0f, 0.40f, 0.80f, 0.50f, 0.030f, 104},
    {5.0f, 24.0f, 0.47f, 0.95f, 0.46f, 0.032f, 105},
    {118.0f, 23.0f, 0.28f, 0.52f, 0.36f, 0.026f, 106},
    {318.0f, 21.0f, 0.27f, 0.50f, 0.32f, 0.024f, 107},
    {170.0f, 28.0f, 0.56f, 0.88f, 0.30f, 0.030f, 108},
}};

float bell(float x) { return shared::as_exp(-0.5f * x * x); }

float tangent(float degrees) {
    return static_cast<float>(real::tan(real::radians(static_cast<double>(degrees))));
}

float wrapped_angle(float a) {
    const float turn = static_cast<float>(2.0 * real::pi);
    return a - turn * std::floor(a / turn + 0.5f);
}

// Bends straight noise-free arms: long waves shift a whole stretch, short ones fray it.
glm::vec2 bent(glm::vec2 p, float r) {
    const float large = 0.045f * smoothstep(0.05f, 0.45f, r);
    const float small = 0.011f * smoothstep(0.03f, 0.25f, r);
    const glm::vec2 a(fbm(p * 2.1f, 11, 3), fbm(p * 2.1f, 21, 3));
    const glm::vec2 b(fbm(p * 11.0f, 31, 4), fbm(p * 11.0f, 41, 4));
    return p + large * a + small * b;
}

void add_arm(DiskPlace& place, const Arm& arm, float log_r) {
    const float slope = tangent(arm.pitch_deg);
    const float start = static_cast<float>(real::radians(static_cast<double>(arm.angle_deg)));
    const float crest_angle = start + (log_r - shared::as_log(arm.from)) / slope;
    // Distance outward from the crest, measured across the arm.
    const float across =
        -wrapped_angle(place.angle - crest_angle) * place.r * slope / std::sqrt(1.0f + slope * slope);
    const float ends = smoothstep(arm.from * 0.75f, arm.from * 1.35f, place.r) *
                       (1.0f - smoothstep(arm.to * 0.72f, arm.to * 1.06f, place.r));
    const float waxing =
        std::clamp(0.85f + 0.9f * noise(glm::vec2(log_r * 4.5f, 0.5f), arm.seed), 0.25f, 1.5f);
    const float width = arm.width * (0.35f + 1.3f * place.r);
    const float strength = arm.strength * ends;
    const float inside = bell(across / (0.55f * width)), outside = bell(across / (1.45f * width));
    place.young += strength * waxing * (across < 0.0f ? inside : 0.7f * outside + 0.3f * inside);
    place.broad += strength * bell((across - 0.2f * width) / (2.6f * width));
    place.ridge += strength * waxing * bell((across - 0.25f * width) / (0.55f * width));
    place.lane += strength * bell((across + 0.85f * width) / (0.34f * width));
}

}  // namespace

DiskPlace disk_place(glm::vec2 p) {
    const float r = std::sqrt(p.x * p.x + p.y * p.y);
    const glm::vec2 q = bent(p, r);
    DiskPlace place;
    place.r = std::max(1e-4f, std::sqrt(q.x * q.x + q.y * q.y));
    place.angle = static_cast<float>(real::atan2(static_cast<double>(q.y), static_cast<double>(q.x)));
    const float log_r = shared::as_log(place.r);
    for (const Arm& arm : arms) add_arm(place, arm, log_r);
    return place;
}

float along_spiral(const DiskPlace& place, float pitch_deg, int cells, float stretch, unsigned seed,
                   bool ridges) {
    const float turn = static_cast<float>(2.0 * real::pi);
    const float log_r = shared::as_log(place.r), slope = tangent(pitch_deg);
    const float n = static_cast<float>(cells);
    // Cells are (2 pi sin(pitch) / n) r wide; along the spiral log r grows by sin(pitch) per length / r.
    const float sine2 = slope * slope / (1.0f + slope * slope);
    const glm::vec2 at((place.angle - log_r / slope) * n / turn, log_r * n / (turn * sine2 * stretch));
    return ridges ? ridged(at, seed, 5, 0.55f, cells) : fbm(at, seed, 5, 0.55f, cells);
}

float dust_depth(glm::vec2 p, const DiskPlace& place) {
    const float clumps = shared::as_exp(2.2f * along_spiral(place, 17.0f, 24, 4.0f, 201, false));
    const float threads = along_spiral(place, 19.0f, 46, 4.0f, 211, true);
    const float spurs = along_spiral(place, 46.0f, 26, 3.0f, 221, true);
    const glm::vec2 curl = p + 0.03f * glm::vec2(fbm(p * 8.0f, 231, 3), fbm(p * 8.0f, 241, 3));
    const float web = ridged(curl * 7.0f, 251, 6, 0.62f);
    const float reach = shared::as_exp(-place.r / 0.42f);
    const float lanes =
        place.lane * (0.45f + 1.1f * threads) * clumps * (0.5f + 0.9f * smoothstep(0.9f, 0.15f, place.r));
    const float feathers = place.broad * smoothstep(0.36f, 0.80f, spurs) * clumps;
    const float sheet =
        reach * (0.25f * web + 0.75f * smoothstep(0.32f, 0.75f, web)) * (0.25f + 0.7f * place.broad);
    const float nucleus = clumps * bell((place.r - 0.07f) / 0.035f) *
                          smoothstep(0.30f, 0.8f, along_spiral(place, 33.0f, 5, 2.4f, 261, true));
    const float edge = 1.0f - smoothstep(0.55f, 0.98f, place.r);
    return edge * (1.5f * lanes + 1.0f * feathers * reach * 1.6f + 1.1f * sheet + 0.8f * nucleus);
}

}  // namespace astrosplat::assets
