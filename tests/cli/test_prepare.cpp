// prepare: what it writes, aligns and refuses.

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <sstream>

#include "scene_fixture.h"
#include "source/object_metadata.h"
#include "source/texture.h"
#include "support/fits_text.h"
#include "support/pixmap.h"
#include "support/tan_grid.h"

namespace astrosplat::test {
namespace {

// prepare: what it writes for pictures and FITS, and every refusal.

// Nine stars on a slope.
std::string starry_picture() { return starry_pixmap({96, 64, 32, 21, 120.0, 3.0, 0.3, 2.0}); }

// The same stars as 32-bit floats, on a level far from 0, with one pixel undefined. With a scale (degrees a
// pixel) the header tells the sky.
std::string starry_fits(double scale = 0.0) {
    const std::string sky = scale > 0.0 ? fits_sky(48.5, 32.5, 10.0, 41.0, scale, 0.0) : "";
    return fits_file(96, 64, fits_card("OBJECT  = 'M 51    '") + sky, [](int x, int y) {
        const double u = std::fmod(x, 32.0) - 16.0, v = std::fmod(y, 21.0) - 10.0;
        const double light = 1000.0 + (x * 7 + y * 13) % 5 + 900.0 * std::exp(-(u * u + v * v) / 3.0);
        return x == 3 && y == 3 ? std::nan("") : light;
    });
}

class PrepareCommand : public SceneTest {
  protected:
    PrepareCommand() {
        write_text(folder / "stars.ppm", starry_picture());
        write_text(folder / "stars.fits", starry_fits());
    }
    RunResult prepare(Words more) const { return run(joined({"prepare", "stars.ppm"}, more)); }
    // Lines of a table, its names among them.
    std::size_t lines(const std::string& file) const {
        const std::string text = text_of(folder / file);
        return std::size_t(std::count(text.begin(), text.end(), '\n'));
    }
};

TEST_F(PrepareCommand, WritesAPictureAndATableOfItsStars) {
    const RunResult result = expect_success(prepare({"-o", "ready"}));
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 5) << result.out;
    EXPECT_HAS(result.out, "96x64 px");
    EXPECT_HAS(result.out, "9 taken away, 0 of them saturated");
    EXPECT_TRUE(text_of(folder / "ready/stars.csv")
                    .starts_with("# stars that astrosplat prepare took out of a picture\n"
                                 "x,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n"));
    EXPECT_EQ(lines("ready/stars.csv"), 11u);
    expect_success(run({"prepare", "ready/picture.exr", "-o", "again"}));
    EXPECT_EQ(lines("again/stars.csv"), 2u) << "no star is left";
    expect_success(run({"new", "ready/picture.exr", "-o", "ready.toml"}));
}

// As StarNet and its kin part a picture: what the stars add to the values that are stored.
TEST_F(PrepareCommand, APairIsTheSumAndStarsAreMeasuredAlone) {
    const auto sky = [](int x, int y, int c) {
        return 30 + x + y / 2 + 10 * c + (x % 32 < 3 && y % 21 < 3 ? 60 : 0);
    };
    const auto star = [](int x, int y) {
        const double u = std::fmod(x, 32.0) - 16.0, v = std::fmod(y, 21.0) - 10.0;
        return int(50.0 * std::exp(-(u * u + v * v) / 3.0) + 0.5);
    };
    write_text(folder / "sky.ppm", pixmap(96, 64, sky));
    write_text(folder / "own.ppm", pixmap(96, 64, [&](int x, int y, int) { return star(x, y); }));
    write_text(folder / "sum.ppm",
               pixmap(96, 64, [&](int x, int y, int c) { return sky(x, y, c) + star(x, y); }));
    const auto pair = [&](const char* stars) {
        expect_success(run({"prepare", "own.ppm", "--starless", "sky.ppm", "--stars", stars, "-o", stars}));
        return load_linear_image(folder / stars / "picture.exr").pixels;
    };
    EXPECT_EQ(pair("remove"), load_linear_image(folder / "sky.ppm").pixels);
    // Nine, though the squares of the sky are brighter; what rounding leaves is far fainter than any.
    std::istringstream table(text_of(folder / "remove/stars.csv"));
    std::string line;
    std::getline(table, line);
    std::getline(table, line);
    for (int i = 0; std::getline(table, line); ++i) {
        double x = 0.0, y = 0.0, u = 0.0, v = 0.0, red = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &x, &y, &u, &v, &red), 5);
        EXPECT_EQ(red > 0.5, i < 9) << line;
        EXPECT_EQ(red > 0.01, i < 9) << line;
        if (i < 9) {
            EXPECT_NEAR(std::fmod(x, 32.0), 16.5, 0.1) << line;
        }
    }
    EXPECT_EQ(pair("keep"), load_linear_image(folder / "sum.ppm").pixels);
    expect_success(run({"new", "--starless", "sky.ppm", "--stars", "own.ppm", "-o", "pair.toml"}));
    EXPECT_EQ(text_of(folder / "pair_stars.csv"), text_of(folder / "remove/stars.csv"));
    EXPECT_HAS(text_of(folder / "pair.toml"), "prepare   = { starless = \"sky.ppm\", stars = \"remove\" }");
    expect_success(run({"--batch", "pair.toml", "-f", "1", "--dry-run"}));
    expect_one_line(run({"new", "--starless", "sky.ppm", "--stars", "own.ppm", "-o", "pair.toml"}), 2,
                    "pair.toml");
    expect_one_line(run({"new", "--starless", "sky.ppm"}), 2,
                    "expected IMAGE, or --starless A and --stars B");
    expect_one_line(run({"new"}), 2, "expected IMAGE, or --starless A and --stars B");
    write_text(folder / "small.ppm", pixmap(9, 9, sky));
    expect_one_line(run({"prepare", "own.ppm", "--starless", "small.ppm", "-o", "x", "--progress", "none"}),
                    2, "small.ppm: expected 96x64 px of 3 channels like own.ppm, found 9x9 px of 3");
    write_text(folder / "sky.fits", fits_file(96, 64, "", [&](int x, int y) { return sky(x, 63 - y, 0); }));
    write_text(folder / "own.fits", fits_file(96, 64, "", [&](int x, int y) { return star(x, 63 - y); }));
    expect_success(run({"prepare", "own.fits", "--starless", "sky.fits", "--stars", "remove", "--black", "0",
                        "--white", "100", "--stretch", "linear", "-o", "fits"}));
    EXPECT_FLOAT_EQ(load_linear_image(folder / "fits/picture.exr").at(5, 7)[0], float(sky(5, 7, 0)) / 100.0f);
    EXPECT_EQ(lines("fits/stars.csv"), 11u);
}

TEST_F(PrepareCommand, KeepsWhatIsNotAsked) {
    expect_success(prepare({"-o", "kept", "--stars", "keep"}));
    EXPECT_FALSE(fs::exists(folder / "kept/stars.csv"));
    expect_success(run({"compare", "stars.ppm", "kept/picture.exr", "--max-difference", "0"}));
}

TEST_F(PrepareCommand, TakesStarsFromFitsBeforeItIsStretched) {
    const RunResult result = expect_success(run({"prepare", "stars.fits", "-o", "ready"}));
    EXPECT_HAS(result.out, "9 taken away");
    EXPECT_EQ(read_xmp_metadata(folder / "ready/picture.exr").names, std::vector<std::string>{"M 51"});
    EXPECT_HAS(result.out, "linear light, alpha") << "a pixel has no value: " << result.out;
    expect_success(run({"prepare", "stars.fits", "-o", "kept", "--stars", "keep", "--stretch", "linear"}));
    expect_success(run({"prepare", "stars.fits", "-o", "log", "--stars", "keep", "--stretch", "log"}));
    EXPECT_EQ(run({"compare", "kept/picture.exr", "log/picture.exr", "--max-difference", "0.01"}).code, 3);
}

TEST_F(PrepareCommand, SaturationAndThresholdAct) {
    expect_success(prepare({"-o", "saturated", "--saturation", "0.2"}));
    EXPECT_HAS(text_of(folder / "saturated/stars.csv"), ",1\n");
    expect_success(prepare({"-o", "none", "--threshold", "1e6"}));
    EXPECT_EQ(lines("none/stars.csv"), 2u);
}

TEST_F(PrepareCommand, TakesTheSkyOffAndSaysSo) {
    expect_success(prepare({"-o", "plane", "--background", "plane", "--stars", "keep"}));
    const nlohmann::json sky = json("plane/background.json");
    EXPECT_GT(sky.at("red").at(0).get<double>(), 0.04);
    EXPECT_GT(sky.at("red").at(1).get<double>(), 0.005) << "it is brighter at the right";
    EXPECT_EQ(sky.at("red").at(3).get<double>(), 0.0);
    EXPECT_EQ(run({"compare", "stars.ppm", "plane/picture.exr", "--max-difference", "0.03"}).code, 3);
}

TEST_F(PrepareCommand, CutsAndSplits) {
    std::string mask = "P5\n96 64\n255\n" + std::string(96 * 64, '\0');
    for (int y = 20; y < 40; ++y)
        for (int x = 6; x < 26; ++x) mask[mask.size() - 96 * 64 + y * 96 + x] = '\xff';
    write_text(folder / "mask.pgm", mask);
    const RunResult cut =
        expect_success(prepare({"-o", "cut", "--ellipse", "48,32,20,20", "--turn", "30", "--feather", "0.5",
                                "--alpha", "0,0.05", "--stars", "keep"}));
    EXPECT_HAS(cut.out, "linear light, alpha");
    expect_success(prepare({"-o", "masked", "--mask", "mask.pgm", "--stars", "keep"}));
    expect_success(prepare({"-o", "split", "--split", "mask.pgm", "--stars", "keep"}));
    expect_success(run({"compare", "masked/picture.exr", "split/front.exr", "--max-difference", "0"}));
    EXPECT_EQ(run({"compare", "split/picture.exr", "split/back.exr", "--max-difference", "0.05"}).code, 3);
    expect_success(prepare({"-o", "filled", "--fill", "mask.pgm", "--stars", "keep"}));
    expect_success(run({"compare", "filled/picture.exr", "split/back.exr", "--max-difference", "1e-6"}));
}

TEST_F(PrepareCommand, BringsThreeFiltersTogether) {
    write_text(folder / "r.fits", starry_fits(0.001));
    write_text(folder / "g.fits", starry_fits(0.003));
    write_text(folder / "small.ppm", "P6\n16 16\n255\n" + std::string(16 * 16 * 3, 'x'));
    const auto three = [&](const std::string& g, const std::string& b, Words more) {
        return run(joined({"prepare", "--r", "r.fits", "--g", g, "--b", b, "--progress", "none"}, more));
    };
    expect_success(three("r.fits", "r.fits", {"-o", "gray", "--stars", "keep"}));
    expect_success(three("g.fits", "r.fits", {"-o", "scaled", "--stars", "keep"}));
    EXPECT_EQ(run({"compare", "gray/picture.exr", "scaled/picture.exr", "--max-difference", "0.05"}).code, 3);
    expect_success(three("r.fits", "r.fits",
                         {"-o", "bent", "--stars", "keep", "--lupton-q", "20", "--lupton-stretch", "0.5"}));
    EXPECT_EQ(run({"compare", "gray/picture.exr", "bent/picture.exr", "--max-difference", "0.01"}).code, 3);
    expect_one_line(three("small.ppm", "r.fits", {"-o", "out"}), 2, "expected 96x64 px like r.fits");
    expect_one_line(three("r.fits", "r.fits", {"r.fits", "-o", "out"}), 2, "all three and no other picture");
    expect_one_line(run({"prepare", "--r", "r.fits", "-o", "out"}), 2,
                    "all three and no other picture, found 1 of");
    expect_one_line(run({"prepare", "-o", "out"}), 2, "expected a picture, or --r, --g and --b");
}

TEST_F(PrepareCommand, RefusesWhatItShould) {
    const auto refused = [&](Words more, const std::string& message) {
        more.insert(more.end(), {"-o", "out", "--progress", "none"});
        expect_one_line(prepare(more), 2, message);
    };
    refused({"--threshold", "0"}, "--threshold: expected a number from 0.01 to 1000000000, found 0");
    refused({"--saturation", "much"}, "--saturation: expected a number from 1e-09 to 1000000000 or \"auto\"");
    refused({"--stars", "kept"}, "--stars: expected keep or remove, found 'kept'; did you mean 'keep'?");
    refused({"--stretch", "sqrt"}, "--stretch: expected auto, linear, asinh or log, found 'sqrt'");
    refused({"--stretch", "log"}, "--stretch: expected a FITS picture, found 'stars.ppm'");
    refused({"--background", "steep"}, "--background: expected keep, level, plane or curved, found 'steep'");
    refused({"--ellipse", "1,2,3"}, "--ellipse: expected 4 numbers");
    refused({"--ellipse", "1,2,0,4"}, "--ellipse: expected half axes above 0, found 0 and 4");
    refused({"--ellipse", "1,2,3,4", "--feather", "2"}, "--feather: expected a number from 0 to 1, found 2");
    refused({"--feather", "0.1"}, "--feather: expected --ellipse with it, found none");
    refused({"--threshold", "3", "--stars", "keep"},
            "--threshold: expected --stars \"remove\" with it, found none");
    refused({"--alpha", "0.5,0.5"}, "--alpha: expected the lower end first, found 0.5 and 0.5");
    refused({"--lupton-q", "-1"}, "--lupton-q: expected a number from 1e-06 to 1000000, found -1");
    refused({"--lupton-q", "1"}, "--lupton-q: expected --lupton true with it, found none");
    refused({"--align", "stars.ppm"}, "stars.ppm: expected a FITS picture whose header tells the sky");
    write_text(folder / "small.ppm", "P6\n16 16\n255\n" + std::string(16 * 16 * 3, 'x'));
    for (const char* option : {"--mask", "--fill", "--split"})
        refused({option, "small.ppm"}, "expected 96x64 px like the picture, found 16x16 px");
    expect_one_line(run({"prepare", "missing.png", "-o", "out"}), 2, "missing.png");
    expect_one_line(run({"prepare", "stars.pda", "-o", "out"}), 2, "stars.pda");
    EXPECT_FALSE(fs::exists(folder / "out/picture.exr"));
    write_text(folder / "mine/stars.csv", "mine");
    expect_one_line(prepare({"-o", "mine"}), 2, "--overwrite");
    EXPECT_EQ(text_of(folder / "mine/stars.csv"), "mine");
    expect_success(prepare({"-o", "mine", "--overwrite"}));
    EXPECT_EQ(lines("mine/stars.csv"), 11u);
    EXPECT_EQ(prepare({"-o", "/proc/astrosplat"}).code, 4);
}

// prepare --align: stars of one field, seen by two telescopes, come to lie on each other.

constexpr double ra = 202.47, dec = 47.2;  // degrees: the middle of the field
constexpr double star_sigma = 0.0005;      // degrees

// A telescope that sees the field: its picture's size, how many degrees a pixel covers, how it is turned.
struct Telescope {
    int width, height;
    double scale, turn_deg;

    std::string sky() const {
        return fits_sky(width / 2.0 + 3.0, height / 2.0 - 5.0, ra + 0.002, dec - 0.001, scale, turn_deg);
    }
    TanGrid grid() const {
        const double c = scale * std::cos(turn_deg * 3.14159265358979323846 / 180.0);
        const double s = scale * std::sin(turn_deg * 3.14159265358979323846 / 180.0);
        return {{width / 2.0 + 3.0, height / 2.0 - 5.0}, {ra + 0.002, dec - 0.001}, {-c, s, s, c}};
    }
};

// Places of the sky around the middle, degrees.
std::vector<glm::dvec2> field() {
    std::vector<glm::dvec2> stars;
    for (int i = 0; i < 36; ++i) {
        const double u = (i % 6 - 2.5) * 0.008 + 0.0017 * std::sin(3.0 * i),
                     v = (i / 6 - 2.5) * 0.008 + 0.0017 * std::cos(5.0 * i);
        stars.emplace_back(ra + u / std::cos(dec * 3.14159265358979323846 / 180.0), dec + v);
    }
    return stars;
}

// The field as a telescope sees it: Gaussian stars on a little noise.
std::string picture_by(const Telescope& telescope) {
    std::vector<glm::dvec2> places;
    for (const glm::dvec2& star : field())
        if (const auto place = place_of(telescope.grid(), star)) places.push_back(*place);
    const double sigma = star_sigma / telescope.scale;
    return fits_file(telescope.width, telescope.height, telescope.sky(), [&](int x, int y) {
        double light = 100.0 + (x * 7 + y * 13) % 5;
        for (const glm::dvec2& place : places) {
            const double dx = x + 1.0 - place.x, dy = y + 1.0 - place.y;
            light += 800.0 * std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
        }
        return light;
    });
}

class PrepareAlign : public SceneTest {
  protected:
    // The middle of the light around a place, px from the top left corner.
    static glm::dvec2 centroid(const Image& image, const glm::dvec2& about, double reach) {
        double sum = 0.0;
        glm::dvec2 moment(0.0);
        for (auto y = std::int64_t(about.y - reach); y <= std::int64_t(about.y + reach); ++y)
            for (auto x = std::int64_t(about.x - reach); x <= std::int64_t(about.x + reach); ++x) {
                const glm::dvec2 middle(double(x) + 0.5, double(y) + 0.5);
                const double light = std::max(0.0, double(image.at(x, y)[0]) - 0.1);
                sum += light;
                moment += light * middle;
            }
        return moment / sum;
    }

    // Aligns the picture of `own` with that of `reference`, and compares its stars with where the field lies.
    void expect_aligned(const Telescope& own, const Telescope& reference) const {
        write_text(folder / "own.fits", picture_by(own));
        write_text(folder / "reference.fits", picture_by(reference));
        const RunResult result = expect_success(
            run({"prepare", "own.fits", "--align", "reference.fits", "-o", "out", "--overwrite", "--stars",
                 "keep", "--stretch", "linear", "--white", "1000", "--black", "100"}));
        const std::string size = fmt::format("{}x{} px", reference.width, reference.height);
        EXPECT_HAS(result.out, size);
        const ObjectMetadata said = read_xmp_metadata(folder / "out/picture.exr"),
                             grid = read_fits_metadata(folder / "reference.fits");
        EXPECT_EQ(said.reference_px, grid.reference_px);
        EXPECT_DOUBLE_EQ(said.degrees_per_px.value(), grid.degrees_per_px.value());
        EXPECT_NEAR(said.north_angle.value(), grid.north_angle.value(), 1e-9);
        const Image picture = load_linear_image(folder / "out/picture.exr");
        const double reach = 3.0 * star_sigma / reference.scale;
        int seen = 0;
        double farthest = 0.0;
        for (const glm::dvec2& star : field()) {
            const glm::dvec2 px = place_of(reference.grid(), star).value();
            const glm::dvec2 place(px.x - 0.5, reference.height + 0.5 - px.y);  // from the top left corner
            const glm::dvec2 inside = glm::min(place, glm::dvec2(reference.width, reference.height) - place);
            const glm::dvec2 own_px = place_of(own.grid(), star).value();
            const glm::dvec2 own_inside = glm::min(own_px, glm::dvec2(own.width, own.height) - own_px);
            const double own_reach = 3.0 * star_sigma / own.scale + 3.0;
            if (std::min(inside.x, inside.y) < reach + 2.0 ||
                std::min(own_inside.x, own_inside.y) < own_reach)
                continue;
            ++seen;
            farthest = std::max(farthest, glm::distance(centroid(picture, place, reach), place));
        }
        EXPECT_GE(seen, 30);
        EXPECT_LE(farthest, 0.3);
        RecordProperty(fmt::format("farthest_px_{}", reference.width), fmt::format("{:.3f}", farthest));
    }
};

TEST_F(PrepareAlign, AcrossAScaleOfThreeAndARotation) {
    const Telescope fine{420, 400, 0.00015, 33.0}, coarse{150, 140, 0.00045, -20.0};
    expect_aligned(fine, coarse);
    expect_aligned(coarse, fine);
}

// WCSLIB, ERFA and with them the C library's mathematics say where the pixels of the other lie.
TEST_F(PrepareAlign, WhateverVariantsTheCLibraryPicks) {
    const Telescope own{120, 100, 0.00031, 33.0}, reference{150, 140, 0.00045, -20.0};
    const std::string fk4 = fits_card("RADESYS = 'FK4     '") + fits_card("EQUINOX =               1950.0");
    const auto light = [](int x, int y) { return (x * 37 + y * 11) % 101; };
    for (const std::string& frame : {std::string(), fk4}) {
        write_text(folder / "own.fits", fits_file(own.width, own.height, own.sky() + frame, light));
        write_text(folder / "reference.fits",
                   fits_file(reference.width, reference.height, reference.sky() + frame, light));
        const auto made = [&](const Words& environment) {
            expect_success(run({"prepare", "own.fits", "--align", "reference.fits", "-o", "out",
                                "--overwrite", "--stars", "keep"},
                               {.environment = environment}));
            return load_linear_image(folder / "out/picture.exr").pixels;
        };
        EXPECT_EQ(made({"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA"}), made({})) << frame;
    }
}

TEST_F(PrepareAlign, WhatTheOtherDoesNotShowIsEmpty) {
    const Telescope small{100, 100, 0.00015, 10.0}, large{300, 300, 0.00015, 0.0};
    write_text(folder / "own.fits", picture_by(small));
    write_text(folder / "reference.fits", picture_by(large));
    const RunResult result = expect_success(
        run({"prepare", "own.fits", "--align", "reference.fits", "-o", "out", "--stars", "keep"}));
    EXPECT_HAS(result.out, "300x300 px, linear light, alpha");
}

TEST_F(PrepareAlign, InfoSaysWhereTheSkyIs) {
    const auto info = [&](const std::string& cards) {
        write_text(folder / "a.fits", fits_file(40, 30, cards, [](int x, int) { return double(x); }));
        return nlohmann::json::parse(expect_success(run({"info", "a.fits", "--json"})).out);
    };
    EXPECT_FALSE(info("").contains("sky"));
    const std::string sky = fits_sky(20, 15, ra, dec, 0.001, 0.0);
    EXPECT_NEAR(info(sky).at("sky").at("reference_deg")[0].get<double>(), ra, 1e-9);
    std::string sun = sky;
    for (const auto& [from, to] : {std::pair("RA---TAN", "HPLN-TAN"), std::pair("DEC--TAN", "HPLT-TAN")})
        sun.replace(sun.find(from), 8, to);
    EXPECT_EQ(info(sun).at("sky"), "the frame HPLN-TAN, which is not followed");
}

TEST_F(PrepareAlign, NeedsTheSkyOnBoth) {
    const auto dark = [](int, int) { return 1.0; };
    write_text(folder / "plain.fits", fits_file(40, 30, "", dark));
    write_text(folder / "sky.fits", fits_file(40, 30, fits_sky(20, 15, ra, dec, 0.001, 0.0), dark));
    const auto refused = [&](const char* own, const char* reference, const char* named) {
        const RunResult result =
            run({"prepare", own, "--align", reference, "-o", "out", "--progress", "none"});
        expect_one_line(result, 2, named);
    };
    refused("plain.fits", "sky.fits",
            "plain.fits: expected a FITS picture whose header tells the sky, found none");
    refused("sky.fits", "plain.fits",
            "plain.fits: expected a FITS picture whose header tells the sky, found none");
    expect_one_line(run({"prepare", "sky.fits", "--align", "missing.fits", "-o", "out"}), 2, "missing.fits");
    write_text(folder / "far.fits", fits_file(40, 30, fits_sky(20, 15, ra + 90.0, dec, 0.001, 0.0), dark));
    refused("far.fits", "sky.fits", "far.fits: expected a part of the sky that sky.fits shows");
    const auto filters = [&](const char* r, const char* g, const char* b) {
        return run(
            {"prepare", "--r", r, "--g", g, "--b", b, "-o", "out", "--overwrite", "--progress", "none"});
    };
    expect_one_line(filters("sky.fits", "sky.fits", "plain.fits"), 2,
                    "plain.fits: expected a FITS picture whose");
    expect_one_line(filters("plain.fits", "sky.fits", "plain.fits"), 2,
                    "plain.fits: expected a FITS picture");
    expect_success(filters("sky.fits", "sky.fits", "sky.fits"));
}

}  // namespace
}  // namespace astrosplat::test
