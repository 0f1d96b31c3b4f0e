// Camera files in a folder of their own, and tracks to send there and back.
#pragma once

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "camera_files/camera_track.h"
#include "support/errors.h"
#include "support/temp_folder.h"

namespace astrosplat::test {

class CameraFileTest : public testing::Test {
  protected:
    fs::path put(const std::string& name, const std::string& text) { return folder.file(name, text); }
    /// The error that ends the reading of this text, without the folder's name.
    template <class Read>
    std::string refusal(const std::string& name, const std::string& text, const Read& read) {
        const fs::path file = put(name, text);
        return without_folder(ERROR_OF(read(file, FrameRate{})));
    }
    std::string without_folder(std::string message) {
        const std::string inside = folder.path().string() + "/";
        for (std::size_t at; (at = message.find(inside)) != message.npos;) message.erase(at, inside.size());
        return message;
    }

    TempFolder folder;
};

/// 200 frames of a camera that flies far out and turns every way, over the poles too.
inline CameraTrack wild_track() {
    CameraTrack track;
    track.has_fov = true;
    for (int i = 0; i < 200; ++i) {
        const double t = 0.1 * i;
        glm::dvec4 q(std::sin(1.3 * t), std::cos(0.7 * t), std::sin(2.1 * t + 1.0), std::cos(1.9 * t));
        if (i == 50) q = {1.0, 0.0, 0.0, 1.0};   // straight up
        if (i == 51) q = {-1.0, 1.0, 1.0, 1.0};  // straight down, turned
        track.samples.push_back({i - 20.0,
                                 {100.0 * std::sin(t), 1e-3 * t, -50.0 + 7.0 * t},
                                 q / glm::length(q),
                                 20.0 + 0.5 * i,
                                 0.0});
    }
    return track;
}

/// The same frames, places, turns and lenses within 1e-6; q and -q are one turn.
inline void expect_same_way(const CameraTrack& a, const CameraTrack& b) {
    ASSERT_EQ(a.samples.size(), b.samples.size());
    EXPECT_EQ(a.has_fov, b.has_fov);
    for (std::size_t i = 0; i < a.samples.size(); ++i) {
        SCOPED_TRACE("sample " + std::to_string(i));
        const TrackSample &p = a.samples[i], &q = b.samples[i];
        EXPECT_NEAR(p.frame, q.frame, 1e-6);
        EXPECT_LT(glm::distance(p.eye, q.eye), 1e-6);
        EXPECT_LT(std::fmin(glm::distance(p.rotation, q.rotation), glm::distance(p.rotation, -q.rotation)),
                  1e-6);
        if (a.has_fov) {
            EXPECT_NEAR(p.fov_deg, q.fov_deg, 1e-6);
        }
    }
}

}  // namespace astrosplat::test
