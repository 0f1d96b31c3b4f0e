#include "objects/catalogue.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace astrosplat {
namespace {

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
