// What files say of their object and their sky, and the words on a layer's origin.
#include "source/object_metadata.h"

#include "source/origin.h"
#include "source/picture.h"
#include "support/fits_text.h"
#include "support/quiet.h"
#include "support/test.h"
#include "support/test_data.h"

namespace astrosplat {
namespace {

using Texts = std::vector<std::string>;

std::string packet(const std::string& attributes, const std::string& elements,
                   const std::string& prefix = "avm") {
    return "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF "
           "xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>"
           "<rdf:Description rdf:about='' xmlns:dc='http://purl.org/dc/elements/1.1/' "
           "xmlns:photoshop='http://ns.adobe.com/photoshop/1.0/' xmlns:" +
           prefix + "='http://www.communicatingastronomy.org/avm/1.0/' " + attributes + ">" + elements +
           "</rdf:Description></rdf:RDF></x:xmpmeta>";
}

TEST(XmpMetadata, FromAttributesAndLists) {
    const ObjectMetadata found = find_xmp_metadata(
        "\xFF\xE1 junk " +
        packet("avm:Type='Artwork' avm:Spatial.Rotation='84.5' photoshop:Credit='A &amp; B'",
               "<avm:Subject.Category><rdf:Bag><rdf:li>C.5.1.1</rdf:li><rdf:li>-</rdf:li><rdf:li/>"
               "<rdf:li>C.5.1.2</rdf:li></rdf:Bag></avm:Subject.Category>"
               "<avm:Distance><rdf:Seq><rdf:li>4.6e7</rdf:li><rdf:li>0.002</rdf:li></rdf:Seq></avm:Distance>"
               "<avm:Spatial.Scale><rdf:Seq><rdf:li>-1e-5</rdf:li><rdf:li>1e-5</rdf:li></rdf:Seq></"
               "avm:Spatial.Scale>"
               "<avm:Spatial.ReferenceDimension><rdf:Seq><rdf:li>4000</rdf:li><rdf:li>3000</rdf:li></rdf:Seq>"
               "</avm:Spatial.ReferenceDimension>"
               "<avm:Spatial.ReferenceValue><rdf:Seq><rdf:li>140.5</rdf:li><rdf:li>-51</rdf:li></rdf:Seq>"
               "</avm:Spatial.ReferenceValue>"
               "<dc:title><rdf:Alt><rdf:li xml:lang='x-default'>A\n  spiral</rdf:li></rdf:Alt></dc:title>"
               "<dc:subject><rdf:Bag><rdf:li>NGC 2841</rdf:li></rdf:Bag></dc:subject>"));
    EXPECT_EQ(found.categories, (Texts{"C.5.1.1", "C.5.1.2"}));
    EXPECT_EQ(found.names, Texts{"NGC 2841"});
    EXPECT_EQ(found.title, "A spiral");
    EXPECT_EQ(found.credit, "A & B");
    EXPECT_EQ(found.type, "Artwork");
    EXPECT_EQ(found.distance_ly, 4.6e7);
    EXPECT_DOUBLE_EQ(*found.degrees_per_px, 1e-5);
    EXPECT_EQ(found.reference_px, (std::array{4000.0, 3000.0}));
    EXPECT_NEAR(*found.north_angle, 84.5, 1e-12);
    EXPECT_EQ(found.sky_position, (std::array{140.5, -51.0}));
}

TEST(XmpMetadata, APacketSaysAllOfItAgain) {
    EXPECT_EQ(xmp_packet({}), "");
    ObjectMetadata said;
    said.names = {"M 51", "A & <B>"};
    EXPECT_EQ(find_xmp_metadata(xmp_packet(said)), said);
    said.categories = {"C.5.1.1"};
    said.title = "A \"spiral\"";
    said.credit = "Größe";
    said.type = "Observation";
    said.spectra = {{"HST", "ACS", "Red", "Optical", "R", "850"}, {"HST", "", "Blue", "Optical", "", "435"}};
    said.urls = {"http://a.org/1", "http://a.org/2"};
    said.distance_ly = 2.6e7;
    said.degrees_per_px = 0.25e-4;
    said.north_angle = 0.0;
    said.reference_px = {4000.0, 3000.5};
    said.sky_position = {202.469575, -47.1952583};
    EXPECT_EQ(find_xmp_metadata("junk" + xmp_packet(said) + "junk"), said);
    for (const double turn : {-179.5, -36.9, 90.0, 180.0}) {
        said.north_angle = turn;
        const ObjectMetadata found = find_xmp_metadata(xmp_packet(said));
        EXPECT_DOUBLE_EQ(*found.north_angle, turn);
        EXPECT_DOUBLE_EQ(*found.degrees_per_px, 0.25e-4);
    }
}

/// None of it breaks the XML that other programs have to read.
TEST(XmpMetadata, TextsOfAnyBytesGiveAPacket) {
    ObjectMetadata said;
    said.credit =
        "]]> <b> & \"q\" 'a' \x01\x0b\n Gr\xf6\xdf"
        "e \xef\xbf\xbe |";
    said.id = "abc";
    const std::string packet = xmp_packet(said);
    EXPECT_EQ(find_xmp_metadata(packet).credit, "]]> <b> & \"q\" 'a' Größe |");
    EXPECT_TRUE(packet.starts_with("<?xpacket begin=\"\xef\xbb\xbf\""));
    EXPECT_TRUE(std::ranges::none_of(packet, [](unsigned char c) { return c < 0x20; }));
    EXPECT_EQ(packet.find("]]>"), std::string::npos);
    EXPECT_HAS(packet, "<avm:ID>abc</avm:ID>");
    EXPECT_HAS(packet, "<avm:MetadataVersion>1.2</avm:MetadataVersion>");
}

TEST(MergedMetadata, SaysOfEachSourceWhatItSays) {
    ObjectMetadata a, b;
    a.title = "A spiral";
    a.credit = "NASA; ESA";
    a.names = {"M 51", "Whirlpool"};
    a.categories = {"C.5.1.1"};
    a.type = b.type = "Simulation";
    a.spectra = {{"HST", "ACS", "Red", "Optical", "R", "850"}};
    a.urls = {"http://a.org/1"};
    a.distance_ly = 3e7;
    a.degrees_per_px = 1e-5;
    a.sky_position = {1.0, 2.0};
    b.credit =
        "Gr\xf6\xdf"
        "e";
    b.names = {"NGC 1", "M 51"};
    b.spectra = {{"", "", "Blue", "", "B", ""}, a.spectra[0]};
    const ObjectMetadata all = merged_metadata(std::array{a, b, a});
    EXPECT_EQ(all.title, "A spiral");
    EXPECT_EQ(all.credit, "NASA; ESA; Größe");
    EXPECT_EQ(all.names, (Texts{"M 51", "Whirlpool", "NGC 1"}));
    EXPECT_EQ(all.categories, Texts{"C.5.1.1"});
    EXPECT_EQ(all.spectra, (std::vector{a.spectra[0], b.spectra[0]}));
    EXPECT_EQ(all.urls, Texts{"http://a.org/1"});
    EXPECT_EQ(all.distance_ly, 3e7);
    EXPECT_EQ(all.type, "Simulation");
    EXPECT_FALSE(all.degrees_per_px || all.sky_position || all.north_angle) << "which hold for no other view";
    b.distance_ly = 3.1e7;
    b.type = "Observation";
    EXPECT_FALSE(merged_metadata(std::array{a, b}).distance_ly);
    EXPECT_EQ(merged_metadata(std::array{a, b}).type, "Artwork");
    EXPECT_EQ(merged_metadata({}).type, "Artwork");
}

TEST(MergedMetadata, HundredsOfSourcesStaySmall) {
    std::vector<ObjectMetadata> many(500);
    for (std::size_t i = 0; i < many.size(); ++i) {
        many[i].title = "T" + std::to_string(i);
        many[i].credit = "C" + std::to_string(i) + std::string(100000, 'x');
        many[i].names = {"N" + std::to_string(i)};
    }
    const ObjectMetadata all = merged_metadata(many);
    EXPECT_EQ(all.title, "T0; T1; T2; T3; T4; T5; T6; T7");
    EXPECT_EQ(all.names.size(), 256u);
    EXPECT_HAS(all.credit, "; C499x");
    EXPECT_LT(all.credit.size(), 500u * 4100u);
}

using Listed = std::vector<std::pair<std::string, Texts>>;
Listed listed(const std::vector<AvmTag>& tags) {
    Listed list;
    for (const AvmTag& tag : tags) list.emplace_back(tag.group + " " + tag.name, tag.values);
    return list;
}

TEST(AvmTags, AllOfThemInWordsInTheStandardsOrder) {
    const std::string text = packet(
        "avm:New.Thing='x' avm:Publisher='P' avm:Type='Chart' avm:Spatial.Notes='-'",
        "<avm:Facility><rdf:Seq><rdf:li>A</rdf:li><rdf:li>B</rdf:li></rdf:Seq></avm:Facility>"
        "<i:CreatorContactInfo xmlns:i='http://iptc.org/std/Iptc4xmpCore/1.0/xmlns/' i:CiAdrCity='Garching'>"
        "<rdf:Description><i:CiUrlWork>http://a.org</i:CiUrlWork></rdf:Description></i:CreatorContactInfo>");
    EXPECT_EQ(listed(find_avm_tags(text)), (Listed{{"creator contact", {"Garching", "http://a.org"}},
                                                   {"image type", {"Chart"}},
                                                   {"observation facility", {"A", "B"}},
                                                   {"publisher name", {"P"}},
                                                   {"other New.Thing", {"x"}}}));
    EXPECT_TRUE(find_avm_tags("nothing").empty());
    std::string deep;
    for (int i = 0; i < 200000; ++i) deep += "<avm:Type>";
    for (int i = 0; i < 200000; ++i) deep += "</avm:Type>";
    EXPECT_TRUE(find_avm_tags(packet("", deep)).empty()) << "and no overflow of the stack";
}

TEST(XmpMetadata, PrefixesAreThoseThatThePacketDeclares) {
    EXPECT_EQ(find_xmp_metadata(packet("sky:Type='Chart'", "", "sky")).type, "Chart");
    EXPECT_EQ(find_xmp_metadata(packet("avm:Type='Chart'", "", "sky")).type, "");
}

TEST(XmpMetadata, TheFirstPacketWithAvmElseTheFirst) {
    const std::string plain = packet("photoshop:Credit='first'", ""), broken = "<rdf:RDF><a></rdf:RDF>";
    const std::string avm = packet("avm:Type='Observation' photoshop:Credit='second'", "");
    EXPECT_EQ(find_xmp_metadata(plain + avm).credit, "second");
    EXPECT_EQ(find_xmp_metadata(broken + plain + plain).credit, "first");
    EXPECT_EQ(find_xmp_metadata(broken).credit, "");
    const TempFolder folder;
    const fs::path file = folder.file("a.jpg", broken);
    const Said said;
    EXPECT_EQ(read_xmp_metadata(file).credit, "");
    EXPECT_EQ(said.one_warning(), file.string() + ": its XMP packet is no XML and is not followed");
    EXPECT_EQ(find_xmp_metadata("<rdf:RDF> no end").credit, "");
    EXPECT_EQ(find_xmp_metadata("").credit, "");
    EXPECT_EQ(find_avm_tags(packet("photoshop:Credit='Gr\xf6\xdf' ", ""))[0].values[0], "Gr\xc3\xb6\xc3\x9f")
        << "Latin 1";
}

TEST(XmpMetadata, FiguresThatSayNothingAreLeftOut) {
    const ObjectMetadata found = find_xmp_metadata(
        packet("avm:Spatial.Rotation='-' avm:Spatial.Scale='0'",
               "<avm:Distance><rdf:Seq><rdf:li>-</rdf:li><rdf:li>0.1</rdf:li></rdf:Seq></avm:Distance>"));
    EXPECT_FALSE(found.north_angle);
    EXPECT_FALSE(found.degrees_per_px);
    EXPECT_FALSE(found.distance_ly);
    for (const char* distance : {"inf", "-5", "1e13"})
        EXPECT_FALSE(
            find_xmp_metadata(packet(std::string("avm:Distance='") + distance + "'", "")).distance_ly)
            << distance;
}

std::string list_of(const std::string& property, const std::string& values) {
    std::string items;
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
        end = values.find(' ', begin);
        items += "<rdf:li>" + values.substr(begin, end - begin) + "</rdf:li>";
    }
    return "<avm:" + property + "><rdf:Seq>" + items + "</rdf:Seq></avm:" + property + ">";
}

ObjectMetadata in_the_sky(const std::string& property, const std::string& values,
                          const std::string& attributes = "") {
    return find_xmp_metadata(packet(attributes, list_of(property, values)));
}

// Closed forms: pixel offsets (x, y) are where the sky's are (0, 1), and the angle is atan2(-x, y).
struct OnTheSky {
    const char *values, *rotation;
    double north;  // degrees
};

TEST(XmpMetadata, NorthByScaleAndRotationAlsoInMirroredPictures) {
    for (const auto& [values, rotation, north] :
         {OnTheSky{"-1e-4 1e-4", "0", 0.0}, OnTheSky{"-1e-4 1e-4", "90", 90.0},
          OnTheSky{"-1e-4 1e-4", "180", 180.0}, OnTheSky{"-1e-4 1e-4", "-30", -30.0},
          OnTheSky{"-1e-4 1e-4", "330", -30.0}, OnTheSky{"1e-4 1e-4", "0", 0.0},
          OnTheSky{"1e-4 1e-4", "30", -30.0}, OnTheSky{"1e-4 1e-4", "90", -90.0},
          OnTheSky{"-1e-4 -1e-4", "0", 180.0}, OnTheSky{"-1e-4 -1e-4", "30", 150.0},
          OnTheSky{"1e-4 -1e-4", "90", -90.0}, OnTheSky{"1e-4 -1e-4", "30", -150.0},
          OnTheSky{"1e-4", "30", 30.0}, OnTheSky{"-1e-4", "30", 30.0}}) {
        const ObjectMetadata found =
            in_the_sky("Spatial.Scale", values, std::string("avm:Spatial.Rotation='") + rotation + "'");
        SCOPED_TRACE(std::string(values) + ", " + rotation);
        ASSERT_TRUE(found.north_angle && found.degrees_per_px);
        EXPECT_NEAR(std::remainder(*found.north_angle - north, 360.0), 0.0, 1e-9);
        EXPECT_NEAR(*found.degrees_per_px, 1e-4, 1e-16);
    }
    EXPECT_NEAR(*in_the_sky("Spatial.Scale", "-3e-4 1e-4", "avm:Spatial.Rotation='90'").degrees_per_px, 3e-4,
                1e-16)
        << "pixels that are wider than high";
    EXPECT_FALSE(in_the_sky("Spatial.Scale", "-1e-4 1e-4").north_angle) << "not said";
    EXPECT_EQ(find_xmp_metadata(packet("avm:Spatial.Rotation='200'", "")).north_angle, -160.0);
}

TEST(XmpMetadata, ScaleAndNorthByAMatrixWhereThereIsNoScale) {
    for (const auto& [values, rotation, north] :
         {OnTheSky{"-2e-4 0 0 2e-4", "", 0.0}, OnTheSky{"2e-4 0 0 2e-4", "", 0.0},
          OnTheSky{"2e-4 0 0 -2e-4", "", 180.0}, OnTheSky{"-2e-4 0 0 -2e-4", "", 180.0},
          OnTheSky{"0 -2e-4 -2e-4 0", "", 90.0}, OnTheSky{"0 2e-4 2e-4 0", "", -90.0},
          OnTheSky{"0 -2e-4 2e-4 0", "", -90.0}, OnTheSky{"0 2e-4 -2e-4 0", "", 90.0},
          OnTheSky{"-1.6e-4 -1.2e-4 -1.2e-4 1.6e-4", "", 36.86989764584402}}) {
        const ObjectMetadata found = in_the_sky("Spatial.CDMatrix", values);
        SCOPED_TRACE(values);
        ASSERT_TRUE(found.north_angle && found.degrees_per_px);
        EXPECT_NEAR(std::remainder(*found.north_angle - north, 360.0), 0.0, 1e-9);
        EXPECT_NEAR(*found.degrees_per_px, 2e-4, 1e-16);
    }
    const ObjectMetadata both = find_xmp_metadata(
        packet("", list_of("Spatial.CDMatrix", "0 2e-4 2e-4 0") + list_of("Spatial.Scale", "-1e-4 1e-4")));
    EXPECT_NEAR(*both.degrees_per_px, 1e-4, 1e-16);
    for (const char* none : {"2e-4 0 0", "1 2 2 4", "0 0 0 0", "2e-4 - 0 2e-4", "1e300 0 0 1e300"})
        EXPECT_FALSE(in_the_sky("Spatial.CDMatrix", none).degrees_per_px) << none;
}

// North of the Milky Way is another one.
TEST(XmpMetadata, PlacesAndNorthAreThoseOfTheEarthsSky) {
    for (const auto& [frame, known] : {std::pair("ICRS", true), std::pair("FK5", true),
                                       std::pair("GAL", false), std::pair("ECL", false)}) {
        const ObjectMetadata found = find_xmp_metadata(
            packet(std::string("avm:Spatial.Rotation='10' avm:Spatial.CoordinateFrame='") + frame + "'",
                   list_of("Spatial.Scale", "-1e-4 1e-4") + list_of("Spatial.ReferenceValue", "30 40")));
        EXPECT_EQ(found.north_angle.has_value(), known) << frame;
        EXPECT_EQ(found.sky_position.has_value(), known) << frame;
        EXPECT_TRUE(found.degrees_per_px) << frame;
    }
}

// By the creator where no one is credited, by the rights where there is no creator.
TEST(XmpMetadata, CreditIsWhoeverIsNamed) {
    const std::string creator = "<dc:creator><rdf:Seq><rdf:li>Some\n One</rdf:li></rdf:Seq></dc:creator>";
    const std::string rights = "<dc:rights><rdf:Alt><rdf:li>CC BY</rdf:li></rdf:Alt></dc:rights>";
    EXPECT_EQ(find_xmp_metadata(packet("", creator + rights)).credit, "Some One");
    EXPECT_EQ(find_xmp_metadata(packet("", rights)).credit, "CC BY");
}

TEST(XmpMetadata, IsFoundAtEitherEndOfALargeFile) {
    const TempFolder folder;
    const std::string avm = packet("avm:Type='Observation'", ""), much(9 << 20, 'x');
    EXPECT_EQ(read_xmp_metadata(folder.file("small", avm)).type, "Observation");
    EXPECT_EQ(read_xmp_metadata(folder.file("first", avm + much)).type, "Observation");
    EXPECT_EQ(read_xmp_metadata(folder.file("last", much + avm)).type, "Observation");
    EXPECT_EQ(read_xmp_metadata(folder.file("empty", "")).type, "");
    EXPECT_THROW(read_xmp_metadata(folder / "none"), InputError);
}

// A wallpaper is reduced to cover its screen and cut: 4000x3000 at 1920x1200 shows 4000 px of the width.
TEST(DegreesPerPixel, FollowTheReferenceThatThePictureWasCutFrom) {
    ObjectMetadata metadata;
    EXPECT_FALSE(degrees_per_px_of(metadata, 100, 100));
    metadata.degrees_per_px = 1e-5;
    EXPECT_EQ(degrees_per_px_of(metadata, 1000, 10), 1e-5);
    metadata.reference_px = {4000.0, 3000.0};
    EXPECT_DOUBLE_EQ(*degrees_per_px_of(metadata, 4000, 3000), 1e-5);
    EXPECT_DOUBLE_EQ(*degrees_per_px_of(metadata, 1920, 1200), 1e-5 * 4000 / 1920);
    EXPECT_DOUBLE_EQ(*degrees_per_px_of(metadata, 800, 1200), 1e-5 * 3000 / 1200);
    EXPECT_FALSE(degrees_per_px_of(metadata, 0, 1200));
    metadata = {};
    metadata.degrees_per_px = 0.5;
    EXPECT_TRUE(degrees_per_px_of(metadata, 720, 360));
    EXPECT_FALSE(degrees_per_px_of(metadata, 721, 360)) << "wider than the sky";
}

using Cards = std::vector<std::pair<const char*, double>>;

fs::path write_sky(const TempFolder& folder, const char* name, const std::string& distance_unit,
                   const Cards& more) {
    Cards numbers{{"CRPIX1", 2.0}, {"CRPIX2", 1.5}, {"CRVAL1", 202.5}, {"CRVAL2", 47.2}};
    numbers.insert(numbers.end(), more.begin(), more.end());
    std::string cards = fits_card("OBJECT  = 'M 51    '") + fits_card("CTYPE1  = 'RA---TAN'") +
                        fits_card("CTYPE2  = 'DEC--TAN'");
    for (const auto& [key, value] : numbers) cards += fits_card(fmt::format("{:8}= {:20.12E}", key, value));
    cards += fits_card("DISTANCE=                  2.0 / " + distance_unit);
    return folder.file(name, fits_file(4, 3, cards, [](int x, int y) { return x == 1 && y == 1; }));
}

TEST(FitsMetadata, HasObjectPlaceAndDistance) {
    const TempFolder folder;
    const Cards turned{{"CD1_1", -0.8e-4}, {"CD1_2", -0.6e-4}, {"CD2_1", -0.6e-4}, {"CD2_2", 0.8e-4}};
    const ObjectMetadata found = read_fits_metadata(write_sky(folder, "a.fits", "[Mpc] to it", turned));
    EXPECT_EQ(found.names, Texts{"M 51"});
    EXPECT_NEAR(*found.degrees_per_px, 1e-4, 1e-12);
    EXPECT_NEAR(*found.north_angle, 36.86989764584402, 1e-9);
    EXPECT_EQ(found.sky_position, (std::array{202.5, 47.2}));
    EXPECT_NEAR(*found.distance_ly, 6.523127554e6, 1.0);
    EXPECT_FALSE(read_fits_metadata(write_sky(folder, "b.fits", "to it", turned)).distance_ly)
        << "it has no unit";
    EXPECT_FALSE(read_fits_metadata(write_sky(folder, "c.fits", "", {})).north_angle);
}

// As XMP has them, in all the ways in which a header says it.
TEST(FitsMetadata, NorthAndScaleAlsoInMirroredPictures) {
    constexpr double s = 1e-4;
    const TempFolder folder;
    const auto expect = [&](const Cards& cards, double north) {
        const std::string name = std::to_string(north) + std::to_string(cards.size()) + ".fits";
        const ObjectMetadata found = read_fits_metadata(write_sky(folder, name.c_str(), "", cards));
        fs::remove(folder / name);
        ASSERT_TRUE(found.north_angle && found.degrees_per_px);
        EXPECT_NEAR(std::remainder(*found.north_angle - north, 360.0), 0.0, 1e-9);
        EXPECT_NEAR(*found.degrees_per_px, s, 1e-16);
    };
    expect({{"CD1_1", -s}, {"CD2_2", s}}, 0.0);
    expect({{"CD1_1", s}, {"CD2_2", s}}, 0.0);
    expect({{"CD1_1", s}, {"CD2_2", -s}}, 180.0);
    expect({{"CD1_2", -s}, {"CD2_1", -s}}, 90.0);
    expect({{"CD1_2", s}, {"CD2_1", -s}}, 90.0);
    expect({{"CD1_2", s}, {"CD2_1", s}}, -90.0);
    expect({{"CDELT1", -s}, {"CDELT2", s}}, 0.0);
    expect({{"CDELT1", -s}, {"CDELT2", -s}}, 180.0);
    expect({{"CDELT1", -s}, {"CDELT2", s}, {"CROTA2", 30.0}}, 30.0);
    expect({{"CDELT1", -s}, {"CDELT2", s}, {"CROTA2", 90.0}}, 90.0);
    expect({{"CDELT1", -s}, {"CDELT2", s}, {"CROTA2", 180.0}}, 180.0);
    expect({{"CDELT1", s}, {"CDELT2", s}, {"CROTA2", 30.0}}, -30.0);
    expect({{"CDELT1", s}, {"CDELT2", -s}, {"CROTA2", 30.0}}, -150.0);
    expect({{"CDELT1", -s}, {"CDELT2", s}, {"PC1_1", 0.8}, {"PC1_2", 0.6}, {"PC2_1", -0.6}, {"PC2_2", 0.8}},
           36.86989764584402);
    expect({{"CDELT1", -s}, {"CDELT2", s}, {"PC1_1", 0.8}, {"PC1_2", -0.6}, {"PC2_1", 0.6}, {"PC2_2", 0.8}},
           -36.86989764584402);
}

TEST(XmpMetadata, OfAPublishedPicture) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(images, "images");
    const ObjectMetadata found = read_xmp_metadata(images / "heic1104a.jpg");
    EXPECT_EQ(found.categories, Texts{"C.5.1.1"});
    EXPECT_EQ(found.names, Texts{"NGC 2841"});
    EXPECT_EQ(found.title, "Flocculent spiral NGC 2841");
    EXPECT_NEAR(*degrees_per_px_of(found, 1920, 1200), 1.10356023779e-05 * 3897 / 1920, 1e-12);
    EXPECT_EQ(found.urls, Texts{"http://www.spacetelescope.org/images/heic1104a/"});
    ASSERT_EQ(found.spectra.size(), 4u);
    EXPECT_EQ(found.spectra[2],
              (SpectralBlock{"Hubble Space Telescope", "WFC3", "Orange", "Optical", "H-alpha", "657"}));
    EXPECT_EQ(find_xmp_metadata(xmp_packet(found)).spectra, found.spectra);
    const Listed tags = listed(read_avm_tags(images / "heic1104a.jpg"));
    EXPECT_EQ(tags.size(), 34u) << "two of its notes are empty";
}

// The words on a layer's origin, kind by kind.

constexpr const char* begins = "measured: light and colours, as the picture's camera sees them; modelled: ";
constexpr const char* invents = "; invented: each splat's place within that depth, all backs";
constexpr const char* hides = ", arms and clouds along the line of sight, the dust's far side";

SourceParams bodies(StructureKind kind) {
    SourceParams source;
    source.structure.kind = kind;
    return source;
}

TEST(Origin, OfAGalaxyTellsHowItLiesAndWhatOfItsPlaneIsHidden) {
    SourceParams source = bodies(StructureKind::disk);
    GalaxyParams& galaxy = source.structure.galaxy;
    const auto lies = [&](const std::string& words) { return begins + ("depths, by " + words) + invents; };
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, in the picture's plane"));
    galaxy.inclination = 66.0;
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by 66.0 degrees"));
    galaxy.inclination = 66.1;
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by 66.1 degrees") + hides);
    galaxy.inclination = {};
    EXPECT_EQ(origin_of(source), lies("a disk and a spheroid, inclined by what the picture tells") + hides);
    galaxy.bulge = 1.0;
    EXPECT_EQ(origin_of(source), lies("a spheroid"));
    source.structure.galaxies = {GalaxyParams{}, GalaxyParams{80.0, 0.0, {}, 90.0, {}}};
    EXPECT_EQ(origin_of(source), lies("the disks and spheroids of 2 galaxies") + hides);
}

TEST(Origin, OfOtherBodiesNamesTheirModel) {
    EXPECT_HAS(origin_of(bodies(StructureKind::walls)), "by two walls, the farther apart the brighter;");
    EXPECT_HAS(origin_of(bodies(StructureKind::sheet)), "by a sheet, the nearer the brighter;");
    SourceParams axis = bodies(StructureKind::axis);
    EXPECT_HAS(origin_of(axis), "by rings about an axis, tilted by what the picture tells,");
    axis.structure.tilt = -12.0;
    EXPECT_HAS(origin_of(axis), "tilted by -12.0 degrees,");
    for (const StructureKind kind : {StructureKind::walls, StructureKind::sheet, StructureKind::axis})
        EXPECT_EQ(origin_of(bodies(kind)).find(hides), std::string::npos);
}

TEST(Origin, CountsWhatIsBeyondTheFrameOnceTheSetIsMade) {
    SourceParams source = bodies(StructureKind::sheet);
    EXPECT_FALSE(origin_of(source).ends_with("frame"));
    EXPECT_TRUE(origin_of(source, ShareBeyond{}).ends_with("all backs"));
    source.structure.margin = 0.1;
    EXPECT_TRUE(origin_of(source).ends_with("all backs, all beyond the frame"));
    EXPECT_TRUE(origin_of(source, ShareBeyond{0.304, 0.026})
                    .ends_with("all beyond the frame (30 % of the splats, 3 % of the light)"));
}

TEST(Origin, OfColumnsStarsAndFiles) {
    SourceParams source;
    EXPECT_EQ(origin_of(source),
              "measured: colours, those of the pictures; invented: all places, around the meshes");
    source.kind = SourceKind::splats;
    EXPECT_EQ(origin_of(source), "") << "the file says it itself";
    source.kind = SourceKind::stars;
    EXPECT_EQ(origin_of(source), "measured: light and places, those of the catalogue");
    source.stars.like = "gas";
    EXPECT_EQ(origin_of(source),
              "measured: light and places in the picture, those of its table; invented: depths");
    source.stars.along = "camera";
    EXPECT_EQ(origin_of(source), "invented: all stars");
}

}  // namespace
}  // namespace astrosplat
