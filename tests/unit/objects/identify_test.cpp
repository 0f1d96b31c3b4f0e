
#include "objects/identify.h"

#include "bodies/picture_light.h"
#include "objects/catalogue.h"
#include "objects/impression.h"
#include "source/texture.h"
#include "support/painted_picture.h"
#include "support/printing.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

using enum SkyObject;
using SkyObjects = std::vector<SkyObject>;

SkyObject likeliest(const ObjectClues& clues, const Image& light) {
    return identify(clues, light).guesses.front().object;
}

ObjectClues said_in(std::vector<std::string> categories, std::string title = "", std::string file = "") {
    ObjectClues clues;
    clues.metadata.categories = std::move(categories);
    clues.metadata.title = std::move(title);
    clues.file_name = std::move(file);
    return clues;
}

TEST(Category, MeansKindsByTheMostSpecialEntry) {
    EXPECT_EQ(objects_of_category("C.5.1.4"), SkyObjects{elliptical});
    EXPECT_EQ(objects_of_category("5.1.4"), SkyObjects{elliptical});
    EXPECT_EQ(objects_of_category("C.5.1.1"), SkyObjects{galaxy});
    EXPECT_EQ(objects_of_category("C.5.3.3"), (SkyObjects{galaxy, elliptical}));
    EXPECT_EQ(objects_of_category("D.5.5.3"), SkyObjects{field});
    EXPECT_EQ(objects_of_category("B.3.6.4.2"), SkyObjects{cluster});
    EXPECT_EQ(objects_of_category("B.4.1.3"), SkyObjects{planetary});
    EXPECT_EQ(objects_of_category("B.4.1.33"), SkyObjects{nebula}) << "not 4.1.3";
    EXPECT_EQ(objects_of_category("A.2.2"), SkyObjects{thin});
    for (const char* other : {"E.8.1", "E.9", "", "C", "x.y"})
        EXPECT_TRUE(objects_of_category(other).empty()) << other;
}

// Words win over what is seen, the person's over the file's.
TEST(Identify, BelievesTheFileMoreThanTheLight) {
    const Image spiral = painted::galaxy(400, 250);
    EXPECT_EQ(likeliest({}, spiral), galaxy);
    for (const SkyObject object : {elliptical, nebula, planetary, remnant, field, cluster, thin}) {
        const char* const category[] = {"",        "C.5.1.4", "B.4.2.1",   "B.4.1.3",
                                        "B.4.1.4", "D.6.1.1", "B.3.6.4.2", "A.2.2"};
        EXPECT_EQ(likeliest(said_in({category[int(object)]}), spiral), object) << name_of(object);
    }
    ObjectClues clues = said_in({"B.4.1.3"});
    clues.named = object_named("M 87");
    EXPECT_EQ(likeliest(clues, spiral), elliptical);
}

TEST(Identify, SaysBecauseOfWhat) {
    const Image spiral = painted::galaxy(400, 250);
    EXPECT_EQ(identify(said_in({"C.5.1.1"}), spiral).why, "AVM says C.5.1.1: spiral galaxy");
    EXPECT_EQ(identify(said_in({}, "", "ngc4594"), spiral).why, "M 104 in the table of objects is spiral");
    EXPECT_EQ(identify(said_in({}, "A galaxy by night"), spiral).why, "'A galaxy by night' says galaxy");
    EXPECT_EQ(identify({}, spiral).why, likeness_of(impression_of(spiral)).why);
    EXPECT_EQ(identify(said_in({"B.3"}), spiral).why,
              "AVM says B.3: star; " + likeness_of(impression_of(spiral)).why)
        << "a star may be anything, so the light counts";
}

TEST(Identify, KnowsTheObjectAndHowFarItIs) {
    const Image spiral = painted::galaxy(400, 250);
    ObjectClues clues = said_in({}, "The Sombrero Galaxy");
    const Identification found = identify(clues, spiral);
    ASSERT_TRUE(found.known);
    EXPECT_EQ(found.known->names.front(), "M 104");
    EXPECT_EQ(found.distance_ly, found.known->distance_ly);
    clues.metadata.distance_ly = 5.0;
    EXPECT_EQ(identify(clues, spiral).distance_ly, 5.0) << "the file's own";
    EXPECT_FALSE(identify({}, spiral).known);
}

// A degree at a distance of 180 / pi is as long as 1.
TEST(Identify, PixelsHaveALengthWhereScaleAndDistanceAreKnown) {
    Identification found;
    found.metadata.degrees_per_px = 0.5;
    EXPECT_FALSE(light_years_per_px(found, 100, 80));
    found.distance_ly = 57.29577951308232;
    EXPECT_NEAR(*light_years_per_px(found, 100, 80), 0.5, 1e-15);
    found.metadata.reference_px = {200.0, 160.0};
    EXPECT_NEAR(*light_years_per_px(found, 100, 80), 1.0, 1e-15) << "of a reduced picture";
    found.metadata.degrees_per_px.reset();
    EXPECT_FALSE(light_years_per_px(found, 100, 80));
}

TEST(Identify, IsSureOfSharesThatAddUp) {
    for (const Image& light :
         {painted::galaxy(400, 250), painted::nebula(400, 250), make_image(8, 8, 3, 0.3f)}) {
        const auto guesses = identify({}, light).guesses;
        double sum = 0.0, last = 1.0;
        for (const ObjectGuess& guess : guesses) {
            EXPECT_LE(guess.sure, last);
            last = guess.sure;
            sum += guess.sure;
        }
        EXPECT_GT(sum, 0.9);
        EXPECT_LE(sum, 1.0 + 1e-12);
    }
}

TEST(Identify, TellsPaintedObjectsApart) {
    for (const std::int64_t width : {400, 900}) {
        const std::int64_t height = width * 5 / 8;
        EXPECT_EQ(likeliest({}, painted::galaxy(width, height)), galaxy) << width;
        EXPECT_EQ(likeliest({}, painted::nebula(width, height)), nebula) << width;
    }
}

TEST(Identify, WhatIsTooSmallOrEvenIsANebula) {
    for (const Image& light :
         {make_image(8, 8, 3, 0.3f), make_image(400, 250, 3, 0.3f), make_image(400, 250, 3)}) {
        EXPECT_EQ(likeliest({}, light), nebula);
        EXPECT_NE(identify({}, light).why.find("too even"), std::string::npos);
    }
}

StructureKind structure_in(const Image& light, std::optional<SkyObject> as = {}) {
    return identify({}, light, as).structure;
}

// A nebula is a shell where it stands alone, and a sheet where it does not.
TEST(Identify, ChoosesTheStructure) {
    const Image alone = painted::remnant(400, 250), even = make_image(400, 250, 3, 0.3f);
    EXPECT_EQ(structure_in(painted::galaxy(400, 250)), StructureKind::disk);
    EXPECT_EQ(structure_in(painted::nebula(400, 250)), StructureKind::walls);
    EXPECT_EQ(structure_in(alone), StructureKind::walls);
    EXPECT_EQ(structure_in(alone, nebula), StructureKind::walls);
    EXPECT_EQ(structure_in(even, nebula), StructureKind::sheet);
    EXPECT_EQ(structure_in(make_image(8, 8, 3, 0.3f), nebula), StructureKind::sheet);
    for (const Image& light : {alone, even}) {
        for (const SkyObject object : {galaxy, elliptical, cluster})
            EXPECT_EQ(structure_in(light, object), StructureKind::disk) << name_of(object);
        EXPECT_EQ(structure_in(light, planetary), StructureKind::axis);
        EXPECT_EQ(structure_in(light, remnant), StructureKind::walls);
        for (const SkyObject object : {field, thin})
            EXPECT_EQ(structure_in(light, object), StructureKind::sheet) << name_of(object);
        EXPECT_EQ(identify(said_in({"C.5.1.1"}), light, nebula).why, "") << "a person's word needs no reason";
    }
}

// Of wide light: a bright star is none.
TEST(Impression, HasItsMiddleWhereWideLightIsBrightest) {
    Image light = make_image(640, 400, 3, 0.02f);
    painted::add_point(light, 160.0, 300.0, 30.0, 0.4, 0.3, 0.2);
    painted::add_point(light, 500.0, 100.0, 1.2, 0.9, 0.9, 0.9);
    const glm::dvec2 middle = impression_of(light).middle;
    EXPECT_NEAR(middle.x, 0.25, 0.02);
    EXPECT_NEAR(middle.y, 0.75, 0.02);
    EXPECT_EQ(impression_of(make_image(8, 8, 3, 1.0f)).middle, glm::dvec2(0.5));
    EXPECT_EQ(impression_of(make_image(64, 40, 3)).middle, glm::dvec2(0.5));
    EXPECT_EQ(identify({}, light).middle, middle);
}

Image two_lights(double apart, glm::vec3 left, glm::vec3 right) {
    Image light = make_image(640, 400, 3, 0.01f);
    painted::add_point(light, 320.0 - 0.5 * apart, 200.0, 30.0, left.r, left.g, left.b);
    painted::add_point(light, 320.0 + 0.5 * apart, 200.0, 30.0, right.r, right.g, right.b);
    return light;
}

TEST(Impression, KnowsWhetherBrightPlacesLieTogetherAndRedWithBlue) {
    const glm::vec3 white(0.4f), red(0.5f, 0.2f, 0.02f), blue(0.02f, 0.2f, 0.5f);
    const Impression together = impression_of(two_lights(0.0, white, white)),
                     apart = impression_of(two_lights(300.0, white, white));
    EXPECT_LT(together.together, -3.0);
    EXPECT_GT(apart.together, -2.0);
    EXPECT_GT(apart.like_colors, 0.99);
    EXPECT_LT(impression_of(two_lights(300.0, red, blue)).like_colors, 0.1);
}

TEST(Impression, KnowsWhetherStarsAreAlike) {
    const auto of_stars = [](double brighter) {
        Image light = make_image(640, 400, 3, 0.01f);
        for (int i = 0; i < 40; ++i) {
            const double peak = 0.1 * (i % 5 == 0 ? brighter : 1.0);
            painted::add_point(light, 40.0 + i % 8 * 80.0, 40.0 + i / 8 * 80.0, 1.3, peak, peak, peak);
        }
        return impression_of(light).star_spread;
    };
    EXPECT_NEAR(of_stars(1.0), 0.0, 0.1);
    EXPECT_NEAR(of_stars(8.0), std::log(8.0), 0.3);
}

TEST(LitShareOfRim, CountsThePixelsAtTheEdges) {
    constexpr std::int64_t width = 200, height = 120;
    EXPECT_EQ(lit_share_of_rim(make_image(width, height, 3, 0.2f)), 1.0);
    Image corner = make_image(width, height, 3, 0.0005f);
    EXPECT_EQ(lit_share_of_rim(corner), 0.0);
    for (std::int64_t y = 0; y < height / 2; ++y)
        for (std::int64_t x = 0; x < width / 3; ++x) corner.at(x, y)[0] = 1.0f;
    EXPECT_NEAR(lit_share_of_rim(corner), (0.5 * height + width / 3.0) / (2.0 * (width + height)), 0.02);
}

struct Labelled {
    const char* file;
    SkyObject object;
};
// Of the telescopes' pictures those that the numbers of impression were not made of would be needed for a
// proof; these guard that nothing is lost.
constexpr Labelled labelled[] = {{"heic0304e.jpg", nebula},
                                 {"heic0706a.jpg", galaxy},
                                 {"heic1104a.jpg", galaxy},
                                 {"heic1107a.jpg", galaxy},
                                 {"heic1305a.jpg", galaxy},
                                 {"heic1310a.jpg", planetary},
                                 {"heic1501a.jpg", nebula},
                                 {"heic1608a.jpg", nebula},
                                 {"hubble_deep_field.jpg", field},
                                 {"m101_heic0602a.jpg", galaxy},
                                 {"opo0010a.jpg", nebula},
                                 {"opo0028a.jpg", planetary},
                                 {"opo0328a.jpg", galaxy},
                                 {"opo1347a.jpg", thin},
                                 {"opo9607a.jpg", planetary},
                                 {"potw1451a.jpg", galaxy},
                                 {"potw1542a.jpg", galaxy},
                                 {"potw1751a.jpg", cluster},
                                 {"red_spider_heic0109a.jpg", planetary},
                                 {"m42.png", nebula},
                                 {"ngc891.png", galaxy},
                                 {"sh2-106.png", nebula}};

TEST(Identify, TellsRealObjectsApartWithAndWithoutWhatTheirFilesSay) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(images, "images");
    for (const Labelled& picture : labelled) {
        const Texture texture = load_texture({images / picture.file}, {}, TextureSettings::Wrap::clamp);
        const Image light = picture_light(texture, 0.0).light;
        EXPECT_EQ(likeliest(clues_of(images / picture.file), light), picture.object) << picture.file;
        EXPECT_EQ(likeliest({}, light), picture.object) << picture.file << ": " << identify({}, light).why;
    }
}

const std::string head =
    "# of a "
    "test\nnames,kind,right_ascension_deg,declination_deg,major_arcmin,minor_arcmin,position_angle_deg,"
    "inclination_deg,distance_ly,source\n";

std::string error_of(const std::string& text) {
    try {
        parse_catalogue(text, "t.csv");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string first_name(const CatalogueObject* object) { return object ? object->names.front() : "none"; }

TEST(Catalogue, ReadsARowWithAllFiguresAndOneWithNone) {
    const auto objects = parse_catalogue(
        head + "M 1;Crab Nebula,remnant,83.6,22,7,4.8,126,,6500,a book\nX 1,star,0,-90,,,,,,\n", "t.csv");
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_EQ(objects[0].names, (std::vector<std::string>{"M 1", "Crab Nebula"}));
    EXPECT_EQ(objects[0].kind, ObjectKind::remnant);
    EXPECT_EQ(objects[0].right_ascension_deg, 83.6);
    EXPECT_EQ(objects[0].major_arcmin, 7.0);
    EXPECT_EQ(objects[0].minor_arcmin, 4.8);
    EXPECT_EQ(objects[0].position_angle_deg, 126.0);
    EXPECT_FALSE(objects[0].inclination_deg);
    EXPECT_EQ(objects[0].distance_ly, 6500.0);
    EXPECT_EQ(objects[0].source, "a book");
    EXPECT_FALSE(objects[1].distance_ly);
}

TEST(Catalogue, RefusesWhatItDoesNotUnderstand) {
    EXPECT_EQ(error_of("names,kind\n").substr(0, 17), "t.csv:1: expected");
    EXPECT_EQ(error_of(head + "M 1,comet,1,2,,,,,,\n").substr(0, 23), "t.csv:3: expected spira");
    EXPECT_EQ(error_of(head + "M 1,star,x,2,,,,,,\n"),
              "t.csv:3: expected a number for the right ascension, found 'x'");
    EXPECT_EQ(error_of(head + "M 1,star,1\n"), "t.csv:3: expected 10 fields, found 3");
    EXPECT_EQ(error_of(head + ",star,1,2,,,,,,\n"), "t.csv:3: expected a name, found none");
}

TEST(Catalogue, OfTheAssetsHasWhatIsPicturedMuch) {
    EXPECT_GE(object_catalogue().size(), 300u);
    for (int i = 1; i <= 110; ++i) EXPECT_TRUE(object_named("M " + std::to_string(i))) << i;
    for (int i = 1; i <= 109; ++i) EXPECT_TRUE(object_named("Caldwell " + std::to_string(i))) << i;
}

TEST(Catalogue, NamesAreFoundAsPeopleWriteThem) {
    for (const char* name :
         {"M104", "m 104", "Messier 104", "NGC 4594", "ngc04594", "Sombrero Galaxy", "sombrero-galaxy"})
        EXPECT_EQ(first_name(object_named(name)), "M 104") << name;
    EXPECT_EQ(first_name(object_named("NGC 0891")), first_name(object_named("C 23")));
    for (const char* name : {"Sh2-106", "sharpless 106", "SH 2-106", "sh2_106"})
        EXPECT_EQ(first_name(object_named(name)), "Sh2-106") << name;
    EXPECT_EQ(first_name(object_named("cats eye nebula")), first_name(object_named("Cat's Eye Nebula")));
    EXPECT_FALSE(object_named("M 111"));
    EXPECT_FALSE(object_named(""));
    EXPECT_FALSE(object_named("M 10 4"));
}

TEST(Catalogue, NamesAreFoundInTextsThatAreNotOnlyNames) {
    EXPECT_EQ(first_name(object_in("m101_heic0602a")), "M 101");
    EXPECT_EQ(first_name(object_in("IMG NGC-0891 final v2")), first_name(object_named("NGC 891")));
    EXPECT_EQ(first_name(object_in("Hubble mosaic of the majestic Sombrero Galaxy")), "M 104");
    EXPECT_EQ(first_name(object_in("the sombrero galaxy (messier 104)")), "M 104");
    EXPECT_EQ(first_name(object_in("NGC 2841 and M 101")), "NGC 2841") << "the first";
    for (const char* text :
         {"heic1104a", "c 14", "frame 0104", "my owl", "ngc", "form 101", "M", "im104", ""})
        EXPECT_FALSE(object_in(text)) << text << ": " << first_name(object_in(text));
}

}  // namespace
}  // namespace astrosplat
