// A window's session on a scene of one disk, of the painted galaxy in so many positions, and a clock that
// stands still but for what a test adds.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <glm/vec2.hpp>
#include <thread>

#include "gl/gl_fixture.h"
#include "support/quiet.h"
#include "support/temp_folder.h"
#include "viewer/session.h"

namespace astrosplat::test {

class DiskSession : public GlTest {
  protected:
    DiskSession(std::int64_t count, glm::ivec2 size_px) : session{options(count), {}}, size_px_(size_px) {}

    void draw() {
        advance(session, now);
        draw_viewport(session, size_px_, now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    const Quiet quiet;
    double now = 1000.0;  // s
    const TempFolder folder;
    Session session;

  private:
    ViewerOptions options(std::int64_t count) const {
        ViewerOptions options;
        options.input = folder.file(
            "scene.toml", fmt::format("astrosplat = 1\n[camera]\nposition = [0.0, 6.0, 8.0]\n"
                                      "[[layer]]\nname = \"disk\"\n[layer.source]\n"
                                      "meshes = [ {{ mesh = \"plane\", texture = \"{}\" }} ]\ncount = {}\n",
                                      ASTROSPLAT_SOURCE_DIR "/assets/textures/spiral.jpg", count));
        return options;
    }

    glm::ivec2 size_px_;
};

}  // namespace astrosplat::test
