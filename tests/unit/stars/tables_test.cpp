// Catalogues in VOTables and in tables of FITS files, those of astropy 5.2 (io.votable, io.fits) with what it
// reads from them.
#include <gmock/gmock.h>
#include <zlib.h>

#include "core/text.h"
#include "source/file_tables.h"
#include "stars/catalogue.h"
#include "support/fits_text.h"
#include "support/quiet.h"
#include "support/test.h"

namespace astrosplat {
namespace {

using testing::HasSubstr;

// Three stars of Gaia's columns, the third without a parallax and bp_rp, as BINARY and BINARY2.
const char* const gaia_binary =
    "PhKxIADJJQBAcNctEPvu4EAS9SqK7gUsQIEXzrmhdt5BAxqEQDVbSwBCAGEAcgBuAGEAcgBkAAAAAAAAAAJAJQAAAAAAAMA0QAAA"
    "AAAAQAQAAAAAAABAoAAAP1HrhQBiAAAAAAAAAAAAAAAAAAAAAAAAAANAdnwAAAAAAEBWYAAAAAAAf/gAAAAAAABBSAAAf8AAAABj"
    "AAAAAAAAAAAAAAAA";
const char* const gaia_binary2 =
    "AD4SsSAAySUAQHDXLRD77uBAEvUqiu4FLECBF865oXbeQQMahEA1W0sAQgBhAHIAbgBhAHIAZAAAAAAAAAAAAkAlAAAAAAAAwDRA"
    "AAAAAABABAAAAAAAAECgAAA/UeuFAGIAAAAAAAAAAAAAAAAUAAAAAAAAAANAdnwAAAAAAEBWYAAAAAAAf/gAAAAAAABBSAAAf8AA"
    "AABjAAAAAAAAAAAAAAAA";

// Tables packed by bzip2, in base64: Hipparcos-2 as ASCII with radians; an HDU without stars and one with
// clock readings, scaled 16-bit magnitudes, kpc, and an array.
const char* const hipparcos2_fits =
    "QlpoOTFBWSZTWXFhxsYAAfT/gv6A8wxAg//iv+ffYD/n3mAEAAAIQAHu12boMMpT0geoYhoeoAAAANMgaAADJBpopDynqPImgaBo"
    "AAZAAAAxVDQAADQAB6gAAAANAJEo00U2EJpkRmoABpkDQyaHplA/SjRJcAQQACJ61qfHAZ/bvmRY/VLpAEMqR3tNpgCX0Xn5+HII"
    "LV7WgHh0XmjUgX1GAvY1Ua4Sz0FF8pAgQzcNV0lsclHp3CuubUVHPpREdF8HvjMEm+SBpwBzl2meDduSZyNNpJcLAXP+mbB4kDOU"
    "goRcHgIuQN72v3EMkhjA6RQSQQYUARbWymaE2wp+GDtZIRDE8KAiBGKIceMQHU8C8rutAHERRcWTB4Y/FWNB3hHX2aTY5jpmRVJZ"
    "SpKSiKrpWBZWszNWJIGTNc6pzuM+aBl4g0jZkOIoEl+GKtwGzlpE9u4rrgvQKMdwsAzmhJG/VFIS2gFhIiImwMjm6AyQ2KrzYGVn"
    "flT3ahX1dxl1WKaGzPmFXcKCKtopGvQWiqNMoOTfo1sdKK/WLUboSpW7mRQjIKxouPDMuDi3VCxDqDFOPnt8oSgkEI6illDPvQLG"
    "YzFllYf5ERVsSddiggkdtodqPzwEz1cxg96MoXZsFD4BjRYi9pVLezCssltOmixFpx8d9gO/+kBJLYpbZc8ipQgu/p0ECpF4YIsB"
    "cFBI/xdyRThQkHFhxsY=";
const char* const scaled_fits =
    "QlpoOTFBWSZTWU6AN7EAAmN/pvjb8w5Ii//b/7/fcD/v32DAAEAAQIBACkACZwtMAhJIoaRkAGj1GmjaQGgyaaAyaAGQPUAD0g1U"
    "BtqQMmgAAAGgABoAAAAADjQ0DRpkaaNMgMTBAADQGgNMgMCZAkiEaTI0npBHqbUAaDT1NAGg0PUZHqDQ2kaeiCGSTAlPQj9qvmMI"
    "VRkRMCUIMITIYYZkDSOAQlv3rnbYe7dLLWfvilY+qG8hHwi96jisVxxB4I8t3PprAKALWAZhuCo1wQ6YEjyKl6gsHM6jPUeXmd9k"
    "qg0HhCMJgLECGDCq2msLDFBSzXBHITQK1gZhK+zMlx7q+yZcqcGWwQGIA4XhkHIuIGFyFcyk53ErEIzYDahlyjZYqI4QHAh5Wy8z"
    "NlpbgzDITy5ZVjnT7luCCJw6gXTIiaetcYrR4IEYpZ4CtjKGobCIkmbJokcYyhwarl6CCiKJsqaZASpc4AcQ4OtX+T8gAXiMkqcm"
    "piEdAtTRzJQnV1lohpxnmQTQYqFFzqQxMFx2yK82Kve7SHkLCeT4zGjGMyV+4IqVqpjh1tYlSaMYpGrlMJuLUOErCpDDBSUVOWiy"
    "BSfkVCx3XxV4K61iJuDbuqQq19uINEHIbC+5jE5s0Bk6ZICwUqnDjuC/UtRK7R6XJpcqW2cBvkN83NoUh1IVCCJmD4UwlbOAjlJK"
    "Y4PpHCsiDDLSgccoD5oTE7BwcJBezmBKozpEbSATDMaZcyCwwpMXWgTIkYXgZMkRQYGQpAfhlbMKiRzcKwxLyCwpE1mgHFEYxSGM"
    "RrmI1opGK2aYL+gKywIhSgvh/qqAqFhmUr9W/Okv9IkPBDf4u5IpwoSCdAG9iA==";

const char* const gaia_fields =
    "<FIELD datatype='long' name='source_id'/><FIELD datatype='double' name='ra' unit='deg'/>"
    "<FIELD datatype='double' name='dec' unit='deg'/><FIELD datatype='double' name='parallax' unit='mas'/>"
    "<FIELD datatype='float' name='phot_g_mean_mag' unit='mag'/>"
    "<FIELD datatype='float' name='bp_rp' unit='mag'/>"
    "<FIELD arraysize='7' datatype='unicodeChar' name='name'/>";

std::string votable(const std::string& fields, const std::string& data) {
    return "<?xml version='1.0'?>\n<!-- made by hand -->\n<VOTABLE version='1.4'><RESOURCE><TABLE name='t'>" +
           fields + "<DATA>" + data + "</DATA></TABLE></RESOURCE></VOTABLE>";
}

std::string cells(const std::vector<std::vector<std::string>>& rows) {
    std::string text = "<TABLEDATA>";
    for (const auto& row : rows) {
        text += "<TR>";
        for (const std::string& cell : row) text += "<TD>" + cell + "</TD>";
        text += "</TR>\n";
    }
    return text + "</TABLEDATA>";
}

std::string field(const std::string& name, const std::string& more = "") {
    return "<FIELD datatype='double' name='" + name + "' " + more + "/>";
}

StarCatalogue parse_vot(const std::string& text) { return parse_catalogue(text, "t.vot"); }

void expect_place(const CatalogueStar& star, double ra_deg, double dec_deg, double distance_pc,
                  double magnitude) {
    EXPECT_NEAR(star.ra_deg, ra_deg, 1e-9);
    EXPECT_NEAR(star.dec_deg, dec_deg, 1e-9);
    EXPECT_NEAR(star.distance_pc, distance_pc, 1e-9 * distance_pc);
    EXPECT_NEAR(star.magnitude, magnitude, 1e-9);
}

// G - V of Gaia DR3's documentation, table 5.9, of G = 8.193973541259766 and BP-RP = 2.8336970806121826, and
// of 5 and 0.8199999928474426, computed with numpy.
void expect_gaia(const StarCatalogue& read) {
    ASSERT_EQ(read.stars.size(), 3u);
    EXPECT_EQ(read.bad.count, 0);
    expect_place(read.stars[0], 269.448502525438, 4.7394201, 1000.0 / 546.97594, 9.587421095781256);
    expect_place(read.stars[1], 10.5, -20.25, 400.0, 5.1524701300985685);
    expect_place(read.stars[2], 359.75, 89.5, 0.0, 12.5);
    EXPECT_TRUE(read.stars[1].color_index.has_value());
    EXPECT_FALSE(read.stars[2].color_index.has_value());
}

TEST(VoTable, EveryKindOfDataIsRead) {
    const std::string ends = " </STREAM>";
    expect_gaia(parse_vot(votable(gaia_fields, std::string("<BINARY><STREAM encoding='base64'>\n") +
                                                   gaia_binary + ends + "</BINARY>")));
    std::string wrapped = gaia_binary2;
    wrapped.insert(40, "\n  ");
    expect_gaia(parse_vot(votable(gaia_fields, "<BINARY2><STREAM>" + wrapped + ends + "</BINARY2>")));
    const Said said;
    expect_gaia(
        parse_vot(votable(gaia_fields, cells({{"4472832130942575872", "269.448502525438", "4.7394201",
                                               "546.97594", "8.193973541259766", "2.8336970806121826", "B"},
                                              {"2", " 10.5 ", "-20.25", "2.5", "5", "0.8199999928474426", ""},
                                              {"3", "359.75", "89.5", "NaN", "12.5"}}))));
    EXPECT_EQ(said.one_warning(), "t.vot: phot_g_mean_mag is taken for V, of 1 star");
    std::string prefixed = votable(gaia_fields, cells({{"1", "1", "2", "4", "5", "", ""}}));
    for (const std::string tag : {"VOTABLE", "RESOURCE", "TABLE", "FIELD", "DATA", "TABLEDATA", "TR", "TD"})
        for (const std::string begin : {"<", "</"})
            for (const std::string end : {" ", ">"})
                for (std::size_t at = 0; (at = prefixed.find(begin + tag + end)) != prefixed.npos;)
                    prefixed.replace(at, begin.size(), begin + "vot:");
    expect_place(parse_vot(prefixed).stars.at(0), 1, 2, 250, 5);
}

TEST(VoTable, StreamsPackedByGzipAreReadAndThoseElsewhereRefused) {
    const TempFolder folder;
    const std::string plain = *bytes_of_base64(gaia_binary), file = folder / "packed";
    const gzFile out = gzopen(file.c_str(), "wb");
    gzwrite(out, plain.data(), unsigned(plain.size()));
    gzclose(out);
    expect_gaia(parse_vot(votable(gaia_fields, "<BINARY><STREAM encoding='gzip'>" +
                                                   base64(test::bytes_of(file)) + "</STREAM></BINARY>")));
    EXPECT_EQ(
        ERROR_OF(parse_vot(votable(gaia_fields, "<BINARY><STREAM href='file:///etc/passwd'/></BINARY>"))),
        "t.vot: expected data in the document itself, found a STREAM of 'file:///etc/passwd'");
    EXPECT_EQ(ERROR_OF(parse_vot(votable(gaia_fields, "<FITS><STREAM>AAAA</STREAM></FITS>"))),
              "t.vot: expected TABLEDATA, BINARY or BINARY2, found none");
}

TEST(VoTable, NullsCostNoStarUnlessItNeedsThem) {
    const std::string null = "<FIELD datatype='int' name='plx' unit='mas'><VALUES null='-999'/></FIELD>";
    const std::string fields = field("ra") + field("dec") + field("vmag") + null + field("b-v");
    const StarCatalogue read = parse_vot(votable(
        fields,
        cells({{"1", "2", "3", "-999", ""}, {"1", "2", "", "10", "0.5"}, {"1", "2", "4", "10", "nan"}})));
    ASSERT_EQ(read.stars.size(), 2u);
    expect_place(read.stars[0], 1, 2, 0, 3);
    expect_place(read.stars[1], 1, 2, 100, 4);
    EXPECT_EQ(
        read.bad.text(read.rows),
        "1 of 3 rows cannot be used, at row 2 (row 2: expected -60 to 60 for the magnitude, found none)");
    // Of 32 bits, -999 and 16.
    const std::string two =
        "<FIELD datatype='double' name='ra'/><FIELD datatype='double' name='dec'/>"
        "<FIELD datatype='double' name='mag'/>" +
        null;
    const std::string star(24, '\0');
    const StarCatalogue binary = parse_vot(votable(
        two, "<BINARY><STREAM>" + base64(star + "\xff\xff\xfc\x19" + star + std::string("\0\0\0\x10", 4)) +
                 "</STREAM></BINARY>"));
    ASSERT_EQ(binary.stars.size(), 2u);
    EXPECT_EQ(binary.stars[0].distance_pc, 0.0);
    EXPECT_EQ(binary.stars[1].distance_pc, 62.5);
}

TEST(VoTable, UcdsDecideWhereNamesDoNot) {
    const std::string fields = field("e_alpha", "ucd='stat.error;pos.eq.ra' unit='mas'") +
                               field("alpha2", "ucd='pos.eq.ra' unit='deg'") +
                               field("alpha", "ucd='pos.eq.ra;meta.main' unit='rad'") +
                               field("delta", "ucd='pos.eq.dec;meta.main' unit='rad'") +
                               field("K", "ucd='phot.mag;em.IR.K' unit='mag'") +
                               field("W", "ucd='phot.mag;em.opt.V' unit='mag'") +
                               field("p", "ucd='pos.parallax.trig' unit='arcsec'") +
                               field("c", "ucd='phot.color;em.opt.B;em.opt.V' unit='mag'");
    const StarCatalogue read =
        parse_vot(votable(fields, cells({{"7", "7", "0.5", "-0.25", "8", "3", "0.1", "1.5"}})));
    const double degree = 180.0 / 3.14159265358979324;
    expect_place(read.stars.at(0), 0.5 * degree, -0.25 * degree, 10, 3);
    EXPECT_EQ(read.stars[0].color_index, 1.5);
    const TempFolder folder;
    EXPECT_EQ(kind_of_catalogue(folder.file("a.xml", votable(fields, ""))), CatalogueKind::sky);
    const Said said;
    const std::string infrared = field("ra") + field("dec") + field("K", "ucd='phot.mag;em.IR.K' unit='mag'");
    expect_place(parse_vot(votable(infrared, cells({{"1", "2", "8"}}))).stars.at(0), 1, 2, 0, 8);
    EXPECT_EQ(said.one_warning(), "t.vot: k (phot.mag;em.ir.k) is taken for the magnitude");
}

TEST(Units, AreFollowedOrSaidOrRefused) {
    const auto star = [](const std::string& fields, const std::vector<std::string>& row) {
        return parse_vot(votable(fields, cells({row}))).stars.at(0);
    };
    const std::string place = field("ra", "unit='deg'") + field("dec", "unit='deg'"), mag = field("mag");
    for (const auto& [unit, ra] : {std::pair("hourangle", 90.0), std::pair("h", 90.0), std::pair("deg", 6.0)})
        expect_place(
            star(field("ra", std::string("unit='") + unit + "'") + field("dec") + mag, {"6", "5", "3"}), ra,
            5, 0, 3);
    const std::string clock =
        "<FIELD datatype='char' arraysize='*' name='RA' unit='&quot;h:m:s&quot;'/>"
        "<FIELD datatype='char' arraysize='*' name='DEC' unit='&quot;d:m:s&quot;'/>";
    expect_place(star(clock + mag, {"06 45 08.4", "-16 42 36", "-1.5"}), 101.285, -16.71, 0, -1.5);
    for (const auto& [unit, pc] : {std::pair("kpc", 2000.0), std::pair("lyr", 2 * 0.30660139378555057),
                                   std::pair("pc", 2.0), std::pair("AU", 2 * 4.84813681109536e-6)})
        EXPECT_NEAR(
            star(place + mag + field("dist", std::string("unit='") + unit + "'"), {"1", "2", "3", "2"})
                    .distance_pc /
                pc,
            1.0, 1e-8)
            << unit;
    for (const auto& [unit, pc] : {std::pair("arcsec", 0.5), std::pair("mas", 500.0), std::pair("uas", 5e5)})
        expect_place(
            star(place + mag + field("plx", std::string("unit='") + unit + "'"), {"1", "2", "3", "2"}), 1, 2,
            pc, 3);
    {
        const Said said;
        expect_place(
            star(place + mag + field("dist", "unit='arcmin'") + field("plx"), {"1", "2", "3", "2", "4"}), 1,
            2, 250, 3);
        EXPECT_EQ(said.one_warning(), "t.vot: dist in 'arcmin' is not followed as distance");
    }
    EXPECT_EQ(
        ERROR_OF(star(place + field("Vmag", "unit='Jy'"), {"1", "2", "3"})),
        "t.vot: expected a table with ra, dec and mag among its columns, found no mag (but vmag in 'Jy')");
    // A column of the name but of something else does not stand in the way of the next.
    expect_place(
        star(place + field("V", "unit='km/s'") + field("Hpmag", "unit='mag'"), {"1", "2", "300", "4"}), 1, 2,
        0, 4);
    // What VizieR writes below the names.
    expect_place(
        parse_catalogue(
            "RArad\tDErad\tVmag\tPlx\nrad\trad\tmag\tarcsec\n----\t---\t---\t---\n1.5\t-0.5\t5\t.1\n",
            "t.tsv")
            .stars.at(0),
        85.94366926962348, -28.64788975654116, 10, 5);
    // What astropy writes above them.
    expect_place(
        parse_catalogue("# %ECSV 1.0\n# ---\n# datatype:\n# - {name: ra, unit: rad, datatype: float64}\n"
                        "# - {name: dec, datatype: float64, unit: rad}\n# - {name: mag, unit: mag}\n"
                        "# - {name: parallax, unit: arcsec, datatype: float64}\nra dec mag parallax\n"
                        "1.5 -0.5 5 .1\n",
                        "t.ecsv")
            .stars.at(0),
        85.94366926962348, -28.64788975654116, 10, 5);
    EXPECT_EQ(ERROR_OF(parse_catalogue("ra,dec,mag\ndeg,deg,Jy\n1,2,3\n", "t.csv")),
              "t.csv:line 2: expected a Hipparcos catalogue, or names of columns with ra, dec and mag among "
              "them, found "
              "no mag (but mag in 'Jy') in 'ra,dec,mag'");
}

// As people name columns; the number is half a year of light in parsecs where it is one of light years.
TEST(Units, StandInNames) {
    const auto star = [](const std::string& header, const char* row) {
        return parse_catalogue(header + "\n" + row + "\n", "t.csv").stars.at(0);
    };
    const double ly = 0.30660139378555057;
    expect_place(star("ra [deg],dec [deg],mag [mag],dist [ly]", "6,5,3,2"), 6, 5, 2 * ly, 3);
    expect_place(star("RA (h),Dec (deg),Vmag,Distance (kpc)", "6,5,3,2"), 90, 5, 2000, 3);
    expect_place(star("RA (J2000),Dec (ICRS),mag,dist", "6,5,3,2").ra_deg == 6.0
                     ? star("ra_hours,dec_deg,v_mag,distance_lyr", "6,5,3,2")
                     : CatalogueStar{},
                 90, 5, 2 * ly, 3);
    expect_place(star("ra,dec,mag,parallax_uas", "6,5,3,2"), 6, 5, 5e5, 3);
    expect_place(star("ra,dec,mag", "6h30m36s,-5d30m36s,3"), 97.65, -5.51, 0, 3);
    const Said said;
    expect_place(star("ra,dec,mag,dist (furlong)", "6,5,3,2"), 6, 5, 0, 3);
    EXPECT_EQ(said.one_warning(), "t.csv: dist in 'furlong' is not followed as distance");
}

// BP and RP apart are BP-RP; a temperature is a colour.
TEST(Tables, ColoursOfOtherColumns) {
    const auto color = [](const char* text) {
        return parse_catalogue(text, "t.csv").stars.at(0).color_index;
    };
    const auto apart = color("ra,dec,mag,phot_bp_mean_mag,phot_rp_mean_mag\n1,2,3,5.5,4.25\n"),
               whole = color("ra,dec,mag,bp_rp\n1,2,3,1.25\n"),
               warm = color("ra,dec,mag,teff_gspphot\n1,2,3,5772\n");
    ASSERT_TRUE(apart && whole && warm);
    EXPECT_EQ(*apart, *whole);
    EXPECT_NEAR(*warm, 0.65, 0.02) << "of the Sun";
}

TEST(Tables, Utf16IsRefusedByItsName) {
    const TempFolder folder;
    for (const auto& [bytes, name] : {std::pair(std::string("\xff\xfer\0a\0", 6), "little.csv"),
                                      std::pair(std::string("\xfe\xff\0r\0a", 6), "big.csv")}) {
        const fs::path file = folder.file(name, bytes);
        const std::string message = file.string() + ":1: expected text as UTF-8, found UTF-16";
        EXPECT_EQ(ERROR_OF(kind_of_catalogue(file)), message);
        EXPECT_EQ(ERROR_OF(read_catalogue(file)), message);
    }
}

TEST(Tables, OtherBandsThanVAreSaid) {
    const auto said_of = [](const std::string& header, const std::string& row) {
        const Said said;
        parse_catalogue(header + "\n1,2,3," + row + "\n4,5,6,\n", "t.csv");
        return said.warnings.empty() ? "" : said.one_warning();
    };
    EXPECT_EQ(said_of("ra,dec,Vmag,x", "1"), "");
    EXPECT_EQ(said_of("ra,dec,Hpmag,x", "1"), "t.csv: hpmag is taken for V, of 2 stars");
    EXPECT_EQ(said_of("ra,dec,VTmag,x", "1"), "t.csv: vtmag is taken for V, of 2 stars");
    EXPECT_EQ(said_of("ra,dec,phot_g_mean_mag,bp_rp", "1"),
              "t.csv: phot_g_mean_mag is taken for V, of 1 star");
    EXPECT_EQ(said_of("ra,dec,Gmag,x", "1"), "t.csv: gmag is taken for V, of 2 stars");
}

TEST(VoTable, WhatIsNoTableOfStarsIsOneLine) {
    const auto error = [](const std::string& fields, const std::string& data) {
        return ERROR_OF(parse_vot(votable(fields, data)));
    };
    const std::string star = field("ra") + field("dec") + field("mag");
    const auto binary = [](const std::string& bytes) {
        return "<BINARY><STREAM>" + base64(bytes) + "</STREAM></BINARY>";
    };
    EXPECT_EQ(error(field("ra") + field("x"), ""),
              "t.vot: expected a table with ra, dec and mag among its columns, found no dec, mag");
    EXPECT_THAT(ERROR_OF(parse_vot("<VOTABLE><RESOURCE><TABLE>")), HasSubstr("expected XML, found"));
    EXPECT_THAT(ERROR_OF(parse_vot("<VOTABLE></VOTABLE>")), HasSubstr("found none in 0 tables"));
    EXPECT_EQ(error(star, binary(std::string(25, '\1'))),
              "t.vot:row 2: expected data of whole rows, found their end");
    EXPECT_EQ(error(star, "<BINARY><STREAM>!!</STREAM></BINARY>"),
              "t.vot:row 1: expected a STREAM in base64, found something else");
    // Four bytes that promise 4 GiB; sizes beyond all numbers; rows of nothing without end.
    EXPECT_EQ(error("<FIELD datatype='char' arraysize='*' name='x'/>" + star, binary("\xff\xff\xff\xff")),
              "t.vot:row 1: expected data of whole rows, found their end");
    EXPECT_EQ(error("<FIELD datatype='char' arraysize='99999x99999' name='x'/>" + star, binary("abc")),
              "t.vot: expected an arraysize, found '99999x99999'");
    EXPECT_EQ(error("<FIELD datatype='car' name='x'/>" + star, ""),
              "t.vot: expected a FIELD of a datatype of VOTable, found 'car'");
    std::string none;
    for (const char* const name : {"ra", "dec", "mag"})
        none += std::string("<FIELD datatype='char' arraysize='0' name='") + name + "'/>";
    EXPECT_EQ(error(none, binary("abc")), "t.vot:row 1: expected rows of a size, found rows of no bytes");
    std::string deep = "<VOTABLE>";
    for (int i = 0; i < 100000; ++i) deep += "<RESOURCE>";
    EXPECT_THAT(ERROR_OF(parse_vot(deep)), HasSubstr("expected XML"));
}

TEST(VoTable, TheFirstTableWithStarsIsTaken) {
    const std::string star = field("ra") + field("dec") + field("mag");
    const std::string other = "<TABLE><FIELD datatype='int' name='x'/></TABLE>";
    const std::string stars =
        "<TABLE name='a'>" + star + "<DATA>" + cells({{"1", "2", "3"}}) + "</DATA></TABLE>";
    const Said said;
    expect_place(
        parse_vot("<VOTABLE><RESOURCE>" + other + "<RESOURCE>" + stars + "</RESOURCE></RESOURCE></VOTABLE>")
            .stars.at(0),
        1, 2, 0, 3);
    EXPECT_TRUE(said.warnings.empty());
    parse_vot("<VOTABLE><RESOURCE>" + other + stars + stars + "</RESOURCE></VOTABLE>");
    EXPECT_EQ(said.one_warning(), "t.vot: 2 tables hold stars; table 'a' is taken");
}

TEST(VoTable, WhatItSaysOfItsPlacesAndRowsIsSaid) {
    const auto said_of = [&](const std::string& element) {
        const Said said;
        std::string text = votable(field("ra") + field("dec") + field("mag"), cells({{"1", "2", "3"}}));
        parse_vot(text.insert(text.find("<TABLE"), element));
        return said.warnings.empty() ? "" : said.warnings[0];
    };
    EXPECT_EQ(said_of("<COOSYS ID='a' system='ICRS'/><COOSYS ID='b' system='eq_FK5' equinox='J2000'/>"), "");
    EXPECT_EQ(said_of("<COOSYS ID='a' system='eq_FK4' equinox='B1950'/>"),
              "t.vot: its coordinate system 'eq_fk4' b1950 is not followed: places are taken for ICRS");
    EXPECT_EQ(said_of("<COOSYS ID='a' system='eq_FK5' equinox='2000.0'/>"), "");
    EXPECT_EQ(said_of("<PARAM name='EQUINOX' datatype='char' arraysize='*' value='J2000.0'/>"), "");
    EXPECT_EQ(said_of("<PARAM name='EQUINOX' datatype='char' arraysize='*' value='B1950'/>"),
              "t.vot: its EQUINOX = B1950 is not followed: places are taken for ICRS");
    EXPECT_HAS(said_of("<COOSYS ID='a' system='galactic'/>"), "coordinate system 'galactic'");
    EXPECT_HAS(said_of("<INFO name='QUERY_STATUS' value='OVERFLOW'/>"),
               "QUERY_STATUS is OVERFLOW: rows are missing");
}

TEST(FitsTables, AFrameThatIsNotFollowedIsSaid) {
    const TempFolder folder;
    const auto table_with = [&](const char* last) {
        std::string text = fits_card("SIMPLE  =                    T") +
                           fits_card("BITPIX  =                    8") +
                           fits_card("NAXIS   =                    0") + fits_card("END");
        text.resize(2880, ' ');
        for (const char* card :
             {"XTENSION= 'TABLE   '", "BITPIX  =                    8", "NAXIS   =                    2",
              "NAXIS1  =                    6", "NAXIS2  =                    1",
              "PCOUNT  =                    0", "GCOUNT  =                    1",
              "TFIELDS =                    3", "TTYPE1  = 'RA      '", "TFORM1  = 'F2.0    '",
              "TBCOL1  =                    1", "TTYPE2  = 'DEC     '", "TFORM2  = 'F2.0    '",
              "TBCOL2  =                    3", "TTYPE3  = 'MAG     '", "TFORM3  = 'F2.0    '",
              "TBCOL3  =                    5"})
            text += fits_card(card);
        text += fits_card(last) + fits_card("END");
        text.resize(2 * 2880, ' ');
        text += " 1 2 3";
        text.resize(3 * 2880, ' ');
        return folder.file("a.fits", text);
    };
    const auto said_of = [&](const char* card) {
        const Said said;
        EXPECT_EQ(read_catalogue(table_with(card)).stars.at(0).magnitude, 3.0);
        return said.warnings.empty() ? "" : said.warnings[0];
    };
    EXPECT_EQ(said_of("RADESYS = 'ICRS'"), "");
    EXPECT_HAS(said_of("RADESYS = 'FK4'"), "RADESYS = 'FK4' is not followed: places are taken for ICRS");
    EXPECT_HAS(said_of("EQUINOX =               1950.0"), "EQUINOX = 1950.0 is not followed");
    EXPECT_HAS(said_of("EQUINOX = 'B1950   '"), "EQUINOX = B1950 is not followed: places are taken for ICRS");
    for (const char* const usual :
         {"              2000.0", "'J2000   '", "'J2000.0 '", "'2000.0  '", "'       '"})
        EXPECT_EQ(said_of(fmt::format("EQUINOX = {}", usual).c_str()), "") << usual;
    const fs::path flux = table_with("TUNIT3  = 'Jy'");
    EXPECT_EQ(kind_of_catalogue(flux), CatalogueKind::sky) << "or info would look for a picture";
    EXPECT_HAS(ERROR_OF(read_catalogue(flux)), "found no mag (but mag in 'Jy')");
}

TEST(FitsTables, AreReadAsAstropyWroteThem) {
    const TempFolder folder;
    const fs::path ascii = folder.file("hip.fits.bz2", *bytes_of_base64(hipparcos2_fits));
    const Said said;
    const StarCatalogue hip = read_catalogue(ascii);
    ASSERT_EQ(hip.stars.size(), 2u);
    expect_place(hip.stars[0], 85.94366926962348, -28.64788975654116, 250, 9.25);
    expect_place(hip.stars[1], 14.32394487827058, 71.6197243913529, 0, 3.5);
    EXPECT_EQ(hip.stars[1].color_index, 1.25);
    const fs::path scaled = folder.file("scaled.fits.bz2", *bytes_of_base64(scaled_fits));
    const StarCatalogue read = read_catalogue(scaled);
    ASSERT_EQ(read.stars.size(), 2u);
    expect_place(read.stars[0], 101.285, -16.71, 1000.0 * double(0.0025f), -1.5);
    expect_place(read.stars[1], 270, 4.5, 0, 9);
    EXPECT_HAS(said.one_warning(), "hip.fits.bz2: hpmag is taken for V, of 2 stars");
    EXPECT_EQ(kind_of_catalogue(scaled), CatalogueKind::sky);
    const std::vector<FileTable> tables = fits_tables(scaled);
    ASSERT_EQ(tables.size(), 2u);
    EXPECT_EQ(tables[1].title, "HDU 2 STARS");
    EXPECT_EQ(tables[1].rows->columns()[2].unit, "mag");
    EXPECT_EQ(tables[1].rows->columns()[4].name, "") << "an array";
}

}  // namespace
}  // namespace astrosplat
