// Shared by the tests of splat files: a folder that vanishes, a set with awkward values, comparison bit by
// bit, and the message of an InputError.
#pragma once

#include <cfloat>

#include "core/file_format.h"
#include "splats/splat_set.h"
#include "support/test.h"

namespace astrosplat {

class SplatFileTest : public testing::Test {
  protected:
    ~SplatFileTest() override { set_thread_count(0); }

    fs::path path(const std::string& name) const { return folder_ / name; }

    /// Writes the text as a file of this test.
    fs::path write(const std::string& name, const std::string& bytes) const {
        fs::remove(path(name));  // writing over a file waits for the disk on ext4
        return folder_.file(name, bytes);
    }

  private:
    TempFolder folder_;
};

using test::bytes_of;

/// Of all splat files that have a use, as messages list them.
inline std::string known_endings(FileUse use) {
    return fmt::format("{}", fmt::join(endings_of({FileKind::splats}, use), " "));
}

/// The line an InputError says, without the folder of the file; "" when nothing is thrown.
template <class Read>
std::string error_of(const fs::path& file, Read&& read) {
    try {
        read(file);
    } catch (const InputError& error) {
        std::string line = error.what();
        const std::string folder = file.parent_path().string() + "/";
        if (line.compare(0, folder.size(), folder) == 0) line.erase(0, folder.size());
        return line;
    }
    return "";
}

inline std::uint32_t mix(std::uint32_t v) {
    v = (v ^ v >> 16) * 0x7feb352du;
    v = (v ^ v >> 15) * 0x846ca68bu;
    return v ^ v >> 16;
}

/// Any finite float: hashed bits, now and then a denormal, a zero of either sign or an extreme.
inline float awkward(std::uint32_t n) {
    const float special[] = {0.0f, -0.0f, FLT_MIN, FLT_TRUE_MIN, -FLT_TRUE_MIN, FLT_MAX, -FLT_MAX, 0.1f};
    if (n % 5 == 0) return special[n / 5 % 8];
    const float value = std::bit_cast<float>(mix(n));
    return value - value == 0.0f ? value : 1.0f / 3.0f;
}

/// `rows` splats with every field, in ascending order of 64-bit ids.
inline SplatSet awkward_set(std::uint32_t rows) {
    SplatSet set;
    const auto positive = [](float v) { return v < 0.0f ? -v : v; };
    for (std::uint32_t i = 0; i < rows; ++i) {
        const std::uint32_t n = i * 20;
        set.position.push_back({awkward(n), awkward(n + 1), awkward(n + 2)});
        set.color.push_back({awkward(n + 3), awkward(n + 4), awkward(n + 5)});
        set.alpha.push_back(float(mix(n) >> 8) / 16777216.0f);
        set.distance.push_back(positive(awkward(n + 6)));
        set.radius.push_back(positive(awkward(n + 7)));
        set.id.push_back(i * 0x123456789abull + i);
        set.mesh.push_back(mix(n + 8));
        set.uv.push_back({awkward(n + 9), awkward(n + 10)});
        set.normal.push_back({awkward(n + 11), awkward(n + 12), awkward(n + 13)});
        set.max_distance = std::max(set.max_distance, double{set.distance.back()});
    }
    if (rows > 0) set.id.back() = ~0ull;
    return set;
}

/// The fields that every splat file keeps.
inline void expect_same_splats(const SplatSet& a, const SplatSet& b) {
    EXPECT_TRUE(same_bits(a.position, b.position));
    EXPECT_TRUE(same_bits(a.color, b.color));
    EXPECT_TRUE(same_bits(a.alpha, b.alpha));
    EXPECT_TRUE(same_bits(a.distance, b.distance));
    EXPECT_TRUE(same_bits(a.id, b.id));
    EXPECT_TRUE(same_bits(a.mesh, b.mesh));
    EXPECT_TRUE(same_bits(a.radius, b.radius));
    EXPECT_EQ(a.max_distance, b.max_distance);
}

/// All that a .splats file keeps.
inline void expect_same_set(const SplatSet& a, const SplatSet& b) {
    expect_same_splats(a, b);
    EXPECT_TRUE(same_bits(a.uv, b.uv));
    EXPECT_TRUE(same_bits(a.normal, b.normal));
    EXPECT_EQ(a.spacing, b.spacing);
    EXPECT_EQ(a.generated, b.generated);
    EXPECT_EQ(a.divided, b.divided);
    EXPECT_EQ(a.absorbs, b.absorbs);
    EXPECT_EQ(a.test_positions, b.test_positions);
    EXPECT_EQ(a.zero_alpha, b.zero_alpha);
    EXPECT_EQ(a.credit, b.credit);
}

}  // namespace astrosplat
