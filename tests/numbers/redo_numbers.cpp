// Redoes numbers of the program that came from looking at many pictures, on painted ones: what is measured on
// pictures that are to lie on either side of a number, and where it stands between them. Where the program
// can be asked for its number, it is: it lies where the answer changes. Prints two lines of figures a number;
// exit code 1 where one no longer parts its pictures.
#include <fmt/format.h>

#include "bodies/axis_fit.h"
#include "bodies/fields.h"
#include "bodies/galaxy_fit.h"
#include "core/sorting.h"
#include "image/resample.h"
#include "objects/impression.h"
#include "support/painted_bodies.h"

namespace astrosplat {
namespace {

constexpr std::uint32_t pictures = 8;  // of a kind
constexpr double most_wrong = 0.2;     // of a side's, that may lie on the other one
constexpr std::int64_t width = 320, height = 200;

double between(double least, double most, std::uint32_t picture, std::uint32_t purpose) {
    return std::lerp(least, most, painted::random(1000 + picture, purpose));
}

template <class Make>
auto of_each(const Make& make) {
    std::vector<decltype(make(0u))> made;
    for (std::uint32_t i = 0; i < pictures; ++i) made.push_back(make(i));
    return made;
}

template <class Seen, class Measure>
std::vector<double> measured(const std::vector<Seen>& all, const Measure& measure) {
    std::vector<double> values;
    for (const Seen& one : all) values.push_back(std::invoke(measure, one));
    return values;
}

/// The value of a measure, 0 to `most`, from which on the program's yes or no is another one.
template <class Seen, class Is>
double number_of(double Seen::*measure, Seen one, const Is& is, double most = 1.0) {
    double least = 0.0;
    const auto is_at = [&](double value) { return one.*measure = value, is(one); };
    const bool at_first = is_at(least);
    if (is_at(most) == at_first) throw std::runtime_error("the program does not look at this measure");
    while (most - least > 1e-9) {
        const double middle = 0.5 * (least + most);
        (is_at(middle) == at_first ? least : most) = middle;
    }
    return most;
}

/// Measurements on pictures of one side. Prints them; returns whether most of it lies there.
struct Side {
    std::string_view what;
    std::vector<double> values;

    bool is_parted(double number, bool above) const {
        const auto wrong = std::ranges::count_if(values, [&](double v) { return (v >= number) != above; });
        const double share = double(wrong) / double(values.size());
        fmt::print("    {:<40} {:8.3f} {:8.3f} {:8.3f}, {:.0f} % on the other side\n", what,
                   percentile(values, 0.1), percentile(values, 0.5), percentile(values, 0.9), 100.0 * share);
        return share <= most_wrong;
    }
};

bool all_part = true;

void parts(std::string_view what, double number, const Side& below, const Side& above) {
    fmt::print("{}: {:.3f}\n", what, number);
    const bool low = below.is_parted(number, false), high = above.is_parted(number, true);
    if (!low || !high) fmt::print("    IT DOES NOT PART THEM\n");
    all_part = all_part && low && high;
}

double fbm(double u, double v, double frequency, std::uint32_t seed) {
    return double(painted::fbm(u + 3.0, v + 3.0, frequency, seed));
}

painted::Tilted tilted(std::uint32_t i) {
    return {between(10.0, 75.0, i, 1), between(0.0, 180.0, i, 2), i % 2 == 0,
            between(1.0, 4.0, i, 3),   between(0.7, 2.0, i, 4),   between(0.055, 0.085, i, 5),
            between(0.2, 0.6, i, 6)};
}
Image galaxy(std::uint32_t i) { return painted::tilted_galaxy(width, height, tilted(i)); }

/// Inclined ones with a bulge, behind so much dust.
template <int dust>
Image behind_dust(std::uint32_t i) {
    return painted::tilted_galaxy(width, height, {77.0, between(0.0, 180.0, i, 2), true, 4.0, dust});
}

/// That fills the frame.
Image gas(std::uint32_t i) {
    const double frequency = between(3.0, 6.0, i, 9), level = between(0.25, 0.5, i, 10);
    return painted::of_colors(width, height, [=](double u, double v) {
        const double light = std::max(0.0, level + fbm(u, v, frequency, 31 + i));
        return std::array{0.4 * light + 0.01, 0.2 * light + 0.01, (0.1 + 0.1 * light) * light + 0.01};
    });
}

double size_of_nebula(std::uint32_t i) { return between(0.12, 0.2, i, 11); }

/// Alone on a dark sky.
Image nebula(std::uint32_t i) {
    const double hollow = between(0.0, 0.8, i, 12);
    return painted::of_colors(width, height, [=](double u, double v) {
        const double r = std::hypot(u, 1.2 * v) / (size_of_nebula(i) * (1.0 + 0.4 * fbm(u, v, 6.0, 51 + i)));
        const double threads = std::max(0.1, 1.0 - std::fabs(4.0 * fbm(u, v, 14.0, 71 + i)));
        const double body = std::exp(-std::pow(r, 6.0)) * (1.0 - hollow * std::exp(-4.0 * r * r)) * threads;
        return std::array{0.7 * body + 0.003, 0.3 * body + 0.003, 0.4 * body * r + 0.003};
    });
}

/// Many small things, here and there.
Image field(std::uint32_t i) {
    Image image = make_image(width, height, 3, 0.003f);
    for (std::uint32_t k = 300 * i; k < 300 * (i + 1); ++k) {
        const double light = 0.05 / between(0.1, 1.0, k, 13);
        painted::add_point(image, width * between(0.0, 1.0, k, 14), height * between(0.0, 1.0, k, 15),
                           between(0.7, 2.0, k, 16), light, 0.8 * light, between(0.5, 1.2, k, 17) * light);
    }
    return image;
}

/// A round head and a tail to one side.
Image comet(std::uint32_t i) {
    const double turn = between(0.0, 6.28, i, 18), wide = between(0.25, 0.5, i, 19);
    return painted::of_colors(width, height, [=](double u, double v) {
        const double along = u * std::cos(turn) + v * std::sin(turn);
        const double off = (v * std::cos(turn) - u * std::sin(turn)) / (0.02 + wide * std::max(0.0, along));
        const double head = std::pow(0.03 / (0.03 + std::hypot(u, v)), 2.0);
        const double tail = along < 0.0 ? 0.0 : 0.4 * std::exp(-along / 0.25 - off * off);
        return std::array{head + 0.9 * tail + 0.003, head + tail + 0.003, head + tail + 0.003};
    });
}

// Gentler tilts show of no body.
double tilt_of_body(std::uint32_t i) { return between(25.0, 60.0, i, 20); }

AxisFit fit_body(std::uint32_t i, const painted::BodyLight& light) {
    const Image clean = painted::seen({light, between(0.0, 180.0, i, 21), tilt_of_body(i)}, 0.0);
    const float exposure = 0.9f / std::ranges::max(clean.pixels);
    return fit_axis(painted::with_knots_and_noise(painted::times(copied(clean), exposure)));
}

void redo_axes() {
    const auto rings = of_each([](std::uint32_t i) { return fit_body(i, painted::ring(0.2)); }),
               lobes = of_each([](std::uint32_t i) { return fit_body(i, painted::lobes(0.26)); }),
               shells = of_each([](std::uint32_t i) { return fit_body(i, painted::shell(0.22, 0.15)); }),
               few = of_each([](auto i) { return fit_axis(painted::clouds(12, 4.0, 5.0, 10 * i)); }),
               bubbles = of_each([](auto i) { return fit_axis(painted::shell_among_clouds(10 * i)); });
    AxisFit body;
    body.alike = body.explained = 1.0;
    parts("axis_fit, least_alike", number_of(&AxisFit::alike, body, is_about_axis),
          {"bubbles among clouds", measured(bubbles, &AxisFit::alike)},
          {"lobes", measured(lobes, &AxisFit::alike)});
    parts("axis_fit, least_explained", number_of(&AxisFit::explained, body, is_about_axis),
          {"a dozen clouds", measured(few, &AxisFit::explained)},
          {"lobes", measured(lobes, &AxisFit::explained)});
    const auto spread = [](const AxisFit& fit) { return fit.tilt_to_deg - fit.tilt_from_deg; };
    parts("axis_fit, a tilt that is sure, degrees",
          number_of(&AxisFit::tilt_to_deg, body, std::mem_fn(&AxisFit::tilt_is_sure), 90.0),
          {"rings", measured(rings, spread)}, {"ellipsoids", measured(shells, spread)});
    const auto off = [&](std::uint32_t i) { return std::fabs(lobes[i].tilt_deg - tilt_of_body(i)); };
    parts("axis_fit, rule of the tilt: degrees off", 10.0, {"lobes", of_each(off)},
          {"lobes taken for upright", of_each(tilt_of_body)});
}

void redo_galaxies() {
    const auto fits = [](Image (*paint)(std::uint32_t)) {
        return of_each([=](std::uint32_t i) { return fit_galaxies(paint(i), Galaxies::one).front(); });
    };
    const auto galaxies = fits(galaxy);
    parts("galaxy_fit, most_misfit", number_of(&GalaxyFit::misfit, {}, is_unsure),
          {"galaxies", measured(galaxies, &GalaxyFit::misfit)},
          {"nebulae alone", measured(fits(nebula), &GalaxyFit::misfit)});
    const auto is_guess = [](const GalaxyFit& fit) { return words_of(fit).ends_with("guess"); };
    parts("galaxy_fit, least_sure of the near side", number_of(&GalaxyFit::near_sure, {}, is_guess),
          {"without dust", measured(fits(behind_dust<0>), &GalaxyFit::near_sure)},
          {"with dust", measured(fits(behind_dust<2>), &GalaxyFit::near_sure)});
    const auto truth = [](std::uint32_t i) { return tilted(i).inclination_deg; };
    const auto off = [&](std::uint32_t i) { return std::fabs(galaxies[i].plane.inclination_deg - truth(i)); };
    parts("galaxy_fit, by light and arms: degrees off", 12.0, {"galaxies", of_each(off)},
          {"galaxies taken for face-on", of_each(truth)});
}

void redo_impressions() {
    const auto seen = [](Image (*paint)(std::uint32_t)) {
        return of_each([=](std::uint32_t i) { return impression_of(paint(i)); });
    };
    const auto galaxies = seen(galaxy), gases = seen(gas), nebulae = seen(nebula), fields = seen(field),
               comets = seen(comet);
    const auto share = [](SkyObject as, const Impression& s) { return likeness_of(s).share[int(as)]; };
    const auto is_thin = [=](const Impression& s) { return share(SkyObject::thin, s) > 0.5; };
    const auto is_strewn = [=](const Impression& s) { return share(SkyObject::field, s) > 0.7; };
    const auto is_shell = [](const Impression& s) {
        return structure_of(SkyObject::nebula, s) == StructureKind::walls;
    };
    Impression thin, strewn;  // but for the measure that is asked for
    thin.lit = strewn.lit = true;
    thin.peak = 3.0;
    strewn.small = 1.0;
    const auto row = [&](std::string_view what, double Impression::*measure, const Impression& one,
                         const auto& is, std::string_view low, const auto& below, std::string_view high,
                         const auto& above) {
        parts(what, number_of(measure, one, is, 3.0), {low, measured(below, measure)},
              {high, measured(above, measure)});
    };
    row("is_thin, peak", &Impression::peak, thin, is_thin, "gas", gases, "comets", comets);
    row("is_thin, sides", &Impression::sides, thin, is_thin, "galaxies", galaxies, "comets", comets);
    row("is_thin, detail", &Impression::detail, thin, is_thin, "comets", comets, "nebulae alone", nebulae);
    row("is_thin, small", &Impression::small, thin, is_thin, "comets", comets, "fields", fields);
    row("is_strewn, sides", &Impression::sides, strewn, is_strewn, "galaxies", galaxies, "fields", fields);
    row("is_strewn, small", &Impression::small, strewn, is_strewn, "nebulae alone", nebulae, "fields",
        fields);
    row("structure_of, dark_edge", &Impression::edge, thin, is_shell, "nebulae alone", nebulae, "gas", gases);
}

void redo_walls() {
    const auto share_at = [](const Image& share, double x, double y) {  // px of the picture
        const double texel = double(share.width) / double(width);
        return double(bilinear(share, 0, float(x * texel), float(y * texel)));
    };
    const auto sky_at = [&](double sizes) {
        return of_each([&, sizes](std::uint32_t i) {
            const Image share = find_filled_light(brightest_channel(nebula(i))).sky_share;
            return share_at(share, width * (0.5 + sizes * size_of_nebula(i)), 0.5 * height);
        });
    };
    parts("fields, silhouette_from and _to", 0.5, {"within nebulae", sky_at(0.5)}, {"beyond", sky_at(1.6)});
    const auto core_at = [&](double x) {
        return of_each([&, x](std::uint32_t i) {
            Image image = make_image(width, height, 3, 0.05f);
            const double slope = between(-0.5, 0.5, i, 22), sigma = between(4.0, 7.0, i, 23);
            for (int k = -80; k <= 80; ++k)
                painted::add_point(image, 80.0 + slope * k, 100.0 + k, sigma, 0.1, 0.1, 0.1);
            painted::add_point(image, 240.0, 100.0, between(5.0, 9.0, i, 24), 1.2, 0.9, 0.7);
            return share_at(find_filled_light(brightest_channel(image)).core_share, x, 100.0);
        });
    };
    parts("fields, share_from and _to of cores", 0.5, {"filaments", core_at(80.0)},
          {"cores", core_at(240.0)});
}

}  // namespace
}  // namespace astrosplat

int main() {
    astrosplat::redo_axes();
    astrosplat::redo_galaxies();
    astrosplat::redo_impressions();
    astrosplat::redo_walls();
    return astrosplat::all_part ? 0 : 1;
}
