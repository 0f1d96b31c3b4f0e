// Dust in files of formats that cannot say that a splat absorbs: a warning tells, the native format does not.
#include <gtest/gtest.h>

#include <vector>

#include "core/log.h"
#include "splat_files/splat_file.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

std::vector<std::string> warnings_of(const SplatSet& set, const std::string& name) {
    const TempFolder folder;
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel level, const std::string& line) {
        if (level == LogLevel::warning) warnings.push_back(line);
    });
    write_splats({folder / name, Existing::replace}, set);
    flush_warning_counts();
    set_log_sink(nullptr);
    return warnings;
}

TEST(DustInSplatFiles, IsWarnedOfWhereTheFormatCannotSayIt) {
    SplatSet set;
    set.position.resize(3);
    set.color.resize(3);
    set.alpha.resize(3);
    set.distance.resize(3);
    set.id.resize(3);
    for (std::size_t i = 0; i < 3; ++i) {
        set.color[i] = i == 0 ? glm::vec3(-1.0f, -1.2f, -1.5f) : glm::vec3(0.5f);
        set.id[i] = i;
    }
    set.absorbs = true;
    for (const char* name : {"a.ply", "a.pda"}) {
        const std::vector<std::string> warnings = warnings_of(set, name);
        ASSERT_EQ(warnings.size(), 1u) << name;
        EXPECT_NE(
            warnings[0].find("the dust, 1 splat, absorbs light, which this format cannot say: it becomes "
                             "grey; .splats keeps it"),
            std::string::npos)
            << warnings[0];
    }
    EXPECT_TRUE(warnings_of(set, "a.splats").empty());
    set.absorbs = false;  // then such a color is no dust
    EXPECT_TRUE(warnings_of(set, "a.ply").empty());
    set.color[0] = glm::vec3(0.5f);
    EXPECT_TRUE(warnings_of(set, "a.ply").empty());
}

}  // namespace
}  // namespace astrosplat
