// Captures in files of a few bytes a splat, made byte by byte: what was put in comes out within half a step
// of each format, and wrong files are refused in one line.
#include "core/color.h"
#include "core/memory.h"
#include "splat_files/splat_file.h"
#include "support/packed_captures.h"
#include "unit/splat_files/file_support.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

/// How far numbers may be from those that were put in: half a step.
struct Steps {
    double position, log_scale, alpha, color, harmonic, rotation;
};
constexpr double eight_bits = 0.5 / 255.0;
constexpr Steps spz_steps = {0.5 / 4096, 0.5 / 16, eight_bits, eight_bits / 0.15, 0.5 / 128, 0.0024};

class PackedFiles : public SplatFileTest {
  protected:
    SplatSet read(const std::string& name, const std::string& bytes) {
        return read_splats(write(name, bytes));
    }
    std::string error(const std::string& name, const std::string& bytes) {
        return error_of(write(name, bytes), [](const auto& file) { read_splats(file); });
    }
    void expect_read(const std::string& name, const std::string& bytes, const std::vector<Trained>& all,
                     int degree, const Steps& steps) {
        SCOPED_TRACE(name);
        const SplatSet set = read(name, bytes);
        EXPECT_EQ(splat_count(path(name)), std::int64_t(all.size()));
        const auto attributes = splat_attributes(path(name));
        EXPECT_EQ(std::ranges::count(attributes, "harmonics"), degree > 0);
        ASSERT_EQ(set.size(), std::int64_t(all.size()));
        EXPECT_NO_THROW(check_consistent(set));
        EXPECT_TRUE(set.display_harmonics);
        ASSERT_EQ(set.harmonics.empty(), degree == 0);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Trained& g = all[i];
            SCOPED_TRACE(i);
            EXPECT_EQ(set.id[i], i);
            EXPECT_NEAR(set.alpha[i], g.opacity, steps.alpha + 1e-6);
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(set.position[i][k], g.position[k], steps.position + 1e-6);
                EXPECT_NEAR(std::log(set.scale[i][k]), std::log(g.scale[k]), steps.log_scale + 1e-6);
                const double color = std::max(0.0, 0.5 + 0.28209479177387814 * g.harmonics[0][k]);
                EXPECT_NEAR(real::linear_to_srgb(set.color[i][k]), color,
                            0.28209479177387814 * steps.color + 1e-5);
                for (std::size_t j = 1; j < 16 && degree > 0; ++j)
                    EXPECT_NEAR(set.harmonics[i].c[j][k], g.harmonics[j][k], steps.harmonic + 1e-6) << j;
            }
            // The sine of half the angle between them.
            const double cosine = glm::dot(glm::dvec4(set.rotation[i]), g.rotation);
            EXPECT_NEAR(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), 0.0, steps.rotation);
        }
    }
};

TEST_F(PackedFiles, SpzOfEveryVersionAndDegree) {
    for (const int version : {1, 2, 3, 4})
        for (const int degree : {0, 1, 2, 3}) {
            const std::vector<Trained> all = capture(300, degree);
            Steps steps = spz_steps;
            if (version == 1) steps.position = 0.001;  // half floats up to 3 have steps of 1/512
            // Three numbers off by half a step, and the fourth by the root of twice that where it is near 0.
            if (version < 3) steps.rotation = std::sqrt(2.0 * std::sqrt(3.0) * 0.5 / 127.5);
            expect_read(fmt::format("v{}_{}.spz", version, degree), spz_of(all, degree, version), all, degree,
                        steps);
        }
}

// Version 4 begins with its own name; gzip before it may be anything.
TEST_F(PackedFiles, SpzIsKnownByItsFirstBytes) {
    EXPECT_EQ(read("a.bin", spz_of(capture(3, 0), 0, 4)).size(), 3);
    EXPECT_NE(error("b.bin", spz_of(capture(3, 0), 0, 3)), "");
}

TEST_F(PackedFiles, SpzWithAnyFractionAndLargePlaces) {
    std::vector<Trained> all = capture(50, 0);
    for (Trained& g : all) g.position *= 1000.0;
    Steps steps = spz_steps;
    steps.position = 0.5 / 512.0;
    expect_read("large.spz", spz_of(all, 0, 4, "", 9), all, 0, steps);
}

std::string extension_of(std::uint64_t type, const std::string& content) {
    return number_bytes(type, 4) + number_bytes(content.size(), 4) + content;
}

// Files whose axes are others than right, up, back are turned to what the same capture is in those.
TEST_F(PackedFiles, SpzFollowsTheAxesThatItNames) {
    const std::vector<Trained> all = capture(40, 3);
    for (const int version : {3, 4}) {
        // Right, down, front: as PLY's, so what the file holds is what comes out.
        const SplatSet own = read("rub.spz", spz_of(all, 3, version));
        const std::string axes = extension_of(0xadbe0002, std::string(12, '\0'));
        const SplatSet set =
            read("rdf.spz", spz_of(all, 3, version, axes + extension_of(0xadbe0003, number_bytes(6, 4))));
        const SplatSet up =
            read("lfu.spz", spz_of(all, 3, version, extension_of(0xadbe0003, number_bytes(15, 4))));
        ASSERT_EQ(set.size(), 40);
        for (std::size_t i = 0; i < 40; ++i) {
            const glm::vec3 p = own.position[i], stored(p.x, -p.y, -p.z);
            EXPECT_EQ(set.position[i], stored);
            // Left, front, up: x leads left, y to the front, z up.
            EXPECT_EQ(up.position[i], glm::vec3(-stored.x, -stored.z, stored.y));
            for (std::size_t j = 0; j < 15; ++j)
                EXPECT_NEAR(set.harmonics[i].c[j + 1].x, turned_sign(j) * own.harmonics[i].c[j + 1].x, 1e-5)
                    << j;
        }
    }
}

TEST_F(PackedFiles, SpzSaysWhichExtensionItDoesNotFollow) {
    Said said;
    read("a.spz", spz_of(capture(2, 0), 0, 4, extension_of(0x12340001, "abc")));
    ASSERT_EQ(said.warnings.size(), 1u);
    EXPECT_HAS(said.warnings[0], "a.spz: its extension 0x12340001 is not followed");
}

TEST_F(PackedFiles, WhatNothingReadsIsSaid) {
    const auto said_of = [&](const std::string& name, const std::string& bytes) {
        const Said said;
        EXPECT_EQ(read(name, bytes).size(), 3);
        return said.one_warning();
    };
    const std::string junk(40, 'x');
    const std::vector<Trained> all = capture(3, 1);
    for (const int version : {1, 2, 3, 4})
        EXPECT_HAS(said_of("a.spz", spz_of(all, 1, version) + junk),
                   "a.spz: 40 bytes after its splats are left out")
            << version;
    EXPECT_HAS(said_of("a.ply", compressed_ply_of(all, 1) + junk),
               "a.ply: 40 bytes after its splats are left out");
    EXPECT_HAS(said_of("a.spz", spz_of(all, 1, 4).replace(14, 1, "\x84")),
               "a.spz: its flags 0x84 are not followed");
}

TEST_F(PackedFiles, CompressedPlyOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3})
        for (const bool colors : {true, false}) {
            std::vector<Trained> all = capture(600, degree);  // three chunks
            for (Trained& g : all)
                if (!colors) g.harmonics[0] *= 0.9;  // colours within 0 and 1
            // Bounds of a chunk are 6 apart, logarithms of scales 3, colours 3; one number has 10 bits.
            const double color = colors ? 3.0 * eight_bits : eight_bits / 0.282;
            expect_read("a.ply", compressed_ply_of(all, degree, colors), all, degree,
                        {3.0 / 1023, 1.5 / 1023, eight_bits, color, 4.0 / 256, 0.0025});
        }
}

TEST_F(PackedFiles, DotSplat) {
    const std::vector<Trained> all = capture(300, 0);
    expect_read("a.splat", dot_splat_of(all), all, 0, {0.0, 0.0, eight_bits, eight_bits / 0.282, 0.0, 0.01});
}

TEST_F(PackedFiles, SogOfEveryDegree) {
    for (const int degree : {0, 1, 2, 3})
        for (const bool deflate : {false, true}) {
            const std::vector<Trained> all = capture(300, degree);
            // Positions by ln(1 + |x|), x up to 3: a step of 4/65535 is at most four times that wide.
            expect_read("a.sog", sog_of(all, degree, deflate), all, degree,
                        {4.0 * 2.0 / 65535, 8.0 * eight_bits * 2, eight_bits, 8.0 * eight_bits,
                         8.0 * eight_bits, 0.0075});
        }
}

TEST_F(PackedFiles, WrongSpz) {
    const std::string good = spz_of(capture(5, 1), 1, 4), old = spz_of(capture(5, 1), 1, 2);
    const auto changed = [](std::string bytes, std::size_t at, const std::string& by) {
        return bytes.replace(at, by.size(), by);
    };
    EXPECT_EQ(error("a.spz", "NG"), "a.spz:header: expected 'NGSP', or gzip around it, found 'NG'");
    EXPECT_EQ(error("a.spz", deflated("ply\n and so on and on", 31)),
              "a.spz:header: expected 'NGSP', or gzip around it, found '\\x1f\\x8b\\x08\\x00'");
    EXPECT_EQ(error("a.spz", changed(good, 4, "\x05")), "a.spz:header: expected version 4, found 5");
    EXPECT_EQ(error("a.spz", deflated("NGSP" + number_bytes(4, 4) + std::string(8, '\0'), 31)),
              "a.spz:header: expected version 1, 2 or 3 in gzip, found 4");
    EXPECT_EQ(error("a.spz", changed(good, 12, "\x05")),
              "a.spz:header: expected harmonics of degree 0 to 4, found 5");
    EXPECT_EQ(error("a.spz", changed(good, 13, "\x1f")),
              "a.spz:header: expected at most 30 bits of a fraction, found 31");
    EXPECT_EQ(error("a.spz", changed(good, 15, "\x05")), "a.spz:streams: expected 6 of them, found 5");
    EXPECT_EQ(error("a.spz", changed(good, 16, "\xff\xff\xff\x7f")),
              "a.spz:streams: expected a table of them within the file, found byte 2147483647");
    EXPECT_EQ(error("a.spz", changed(good, 32, std::string(7, '\xff'))),
              fmt::format("a.spz:streams: expected 45 bytes in at most {}, found 45 in 72057594037927935",
                          good.size() - 32 - 96));
    EXPECT_EQ(error("a.spz", changed(good, 8, "\x06")).substr(0, 39),
              "a.spz:streams: expected 54 bytes in at ");
    EXPECT_EQ(error("a.spz", changed(good, 32 + 96 + 6, "\xff\xff\xff")),
              "a.spz:streams: expected 45 bytes compressed by Zstandard, found something else");
    EXPECT_EQ(error("a.spz", old.substr(0, old.size() / 2)).substr(0, 45),
              "a.spz:gzip: expected 156 bytes of 5 splats, f");
    EXPECT_EQ(error("a.spz", spz_of(capture(5, 0), 0, 4, number_bytes(1, 4) + number_bytes(99, 4))),
              "a.spz:extensions: expected 99 bytes, found 0");
}

// Small files that promise much take no memory and no time.
TEST_F(PackedFiles, PromisesOfMuchAreNotBelieved) {
    const std::int64_t before = peak_memory_bytes();
    std::string spz = spz_of(capture(5, 0), 0, 4);
    EXPECT_NE(error("a.spz", spz.replace(8, 4, "\xff\xff\xff\xff")).find("found 4294967295"),
              std::string::npos);
    // 64 MiB of zeros in 64 KiB, of which the header tells nothing: its count may be too small.
    std::string old = "NGSP" + number_bytes(2, 4) + number_bytes(5, 4) + std::string(4, '\0');
    EXPECT_EQ(error("a.spz", deflated(old + std::string(std::size_t{64} << 20, '\0'), 31)),
              "a.spz:gzip: expected 111 bytes of 5 splats, found more");
    old.replace(8, 4, number_bytes(3'000'000, 4));  // which that many zeros do hold
    EXPECT_HAS(error("a.spz", deflated(old + std::string(std::size_t{64} << 20, '\0'), 31)),
               "a.spz:header: expected at most 2000000 splats in 65");
    EXPECT_EQ(error("a.sog", zip_of({{"meta.json", std::string(std::size_t{2} << 20, ' ')}}, true)),
              "a.sog:meta.json: expected at most 1048576 bytes, found 2097152");
    EXPECT_EQ(error("a.ply",
                    "ply\nformat binary_little_endian 1.0\nelement chunk 1152921504606846976\nproperty "
                    "float min_x\nelement vertex 1152921504606846976\nproperty uint packed_position\n"
                    "end_header\n"),
              "a.ply:element chunk: expected 1152921504606846976 rows of 4 bytes, found 0 bytes");
    EXPECT_NE(error("a.sog", zip_of({{"meta.json", R"({"version":2,"count":1152921504606846976})"}}, true))
                  .find("found 1152921504606846976"),
              std::string::npos);
    std::string zip = zip_of({{"meta.json", "{}"}}, true);
    zip.replace(zip.find("PK\1\2") + 24, 4, "\xff\xff\xff\x7f");
    EXPECT_EQ(error("a.sog", zip), "a.sog:meta.json: expected at most 1048576 bytes, found 2147483647");
    EXPECT_LT(peak_memory_bytes() - before, std::int64_t{300} << 20);  // the test's own 64 MiB, twice
}

TEST_F(PackedFiles, WrongOthers) {
    EXPECT_EQ(error("a.splat", std::string(33, 'x')),
              "a.splat:size: expected splats of 32 bytes each, found 33 bytes");
    EXPECT_EQ(error("a.splat", ""), "a.splat:size: expected splats of 32 bytes each, found 0 bytes");
    const std::string ply = compressed_ply_of(capture(300, 1), 1);
    EXPECT_EQ(error("a.ply", ply.substr(0, ply.size() - 1)),
              "a.ply:element sh: expected 300 rows of 9 bytes, found 2699 bytes");
    EXPECT_EQ(error("a.ply", replaced(ply, "element chunk 2", "element chunk 1")),
              "a.ply:element chunk: expected 2 rows for 300 splats, found 1");
    EXPECT_EQ(error("a.ply", replaced(ply, "max_scale_y", "max_scale_x")),
              "a.ply:14: expected each property once, found 'max_scale_x'");
    EXPECT_EQ(error("a.ply", replaced(ply, "max_scale_y", "max_scale_w")),
              "a.ply:element chunk: expected properties of compressed splats, found others");
    EXPECT_EQ(error("a.ply", replaced(ply, "little", "big")),
              "a.ply:header: expected compressed splats as binary_little_endian, found another format");
    const std::vector<Trained> all = capture(5, 1);
    const std::string sog = sog_of(all, 1);
    EXPECT_EQ(error("a.sog", "PK"), "a.sog:ZIP: expected a directory at its end, found none");
    EXPECT_EQ(
        error("a.sog", sog_of(all, 1, false, "")),
        "a.sog:meta.json: expected version 2 (splat-transform makes one of others), found version \"none\"");
    EXPECT_EQ(error("a.sog", replaced(sog, "\"turns.webp\"", "\"turms.webp\"")),
              "a.sog:ZIP: expected a file 'turms.webp', found none");
    EXPECT_EQ(error("a.sog", replaced(sog_of(capture(4, 0), 0), "\"count\":4", "\"count\":5")),
              "a.sog:low.webp: expected about 5 pixels, found 2 x 2");
    EXPECT_EQ(error("a.sog", replaced(sog, "WEBPVP8L", "WEBPVP8?")),
              "a.sog:low.webp: expected a WebP picture, found something else");
    EXPECT_NE(error("a.sog", replaced(sog, "\"bands\":1", "\"bands\":7"))
                  .find("1 to 3 bands of harmonics, found 7"),
              std::string::npos);
    EXPECT_NE(
        error("a.sog", replaced(sog, "\"mins\"", "\"mens\"")).find("expected SOG as its specification says"),
        std::string::npos);
    EXPECT_EQ(error("a.ksplat", "x"), "a.ksplat: expected one of the endings " +
                                          known_endings(FileUse::read) +
                                          ", found .ksplat (splat-transform makes a .ply of it)");
    EXPECT_EQ(conversion_advice("a.png"), "");
}

}  // namespace
}  // namespace astrosplat
