// One crossing in a folder of its own, as the cases of this program have it, and the seeds that they run
// over.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cross/crossing.h"
#include "scene/load.h"
#include "support/quiet.h"
#include "support/temp_folder.h"

namespace astrosplat::test {

inline constexpr std::uint32_t pool = 1500;  // seeds that those of the lane ci are chosen from

/// A scene file in a folder that is named as the crossing has it; its text is told where a case fails.
class Crossings : public testing::TestWithParam<std::uint32_t> {
  protected:
    Crossings() : crossing(crossing_of(GetParam())), text(scene_text(crossing)) {
        folder = outside.path() / folder_name(crossing);
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "scene.toml", std::ios::binary) << text;
        if (crossing.path == CameraPath::csv_file)
            std::ofstream(folder / camera_table_name, std::ios::binary) << camera_table(crossing);
        scene = load_scene(folder / "scene.toml");
    }
    ~Crossings() override {
        if (HasFailure())
            ADD_FAILURE() << "ASTROSPLAT_CROSSING=" << GetParam() << " in '" << folder_name(crossing)
                          << "':\n"
                          << text << camera_table(crossing);
    }

    double frame() const { return static_cast<double>(crossing_frame); }
    Eye eye() const { return eyes_of(crossing).back(); }

    Quiet quiet;
    Crossing crossing;
    std::string text;
    TempFolder outside;
    std::filesystem::path folder;
    Scene scene;
};

/// Those chosen, or the one that a person asks for.
inline std::vector<std::uint32_t> seeds_or_one(std::vector<std::uint32_t> (*chosen)()) {
    if (const char* const alone = std::getenv("ASTROSPLAT_CROSSING"))
        return {static_cast<std::uint32_t>(std::strtoul(alone, nullptr, 10))};
    return chosen();
}

inline std::string seed_name(const testing::TestParamInfo<std::uint32_t>& info) {
    return std::to_string(info.param);
}

}  // namespace astrosplat::test
