#include "cross/inputs.h"

#include <fmt/format.h>

#include "cli/scene_fixture.h"
#include "splat_files/native.h"
#include "splat_files/splat_file.h"
#include "support/capture.h"
#include "support/pixmap.h"
#include "support/temp_folder.h"

namespace astrosplat::test {
namespace {

/// No two places alike, and dim enough that twice its light is still below white.
std::string sky_picture(int width, int height, int number) {
    return pixmap(width, height, [&](int x, int y, int k) {
        return 20 + 15 * number + (90 * x) / width * (k != 1) + (90 * y) / height * (k != 0);
    });
}

/// An ellipse, bright at its rim.
std::string shell() {
    return pixmap(12, 8, [](int x, int y, int k) {
        const double u = (x - 5.5) / 4.5, v = (y - 3.5) / 2.8, r = u * u + v * v;
        return r > 1.0 ? 3 : 60 + static_cast<int>(120.0 * r) - 20 * k;
    });
}

/// A dark field with some small round objects.
std::string deep_field() {
    return pixmap(64, 48, [](int x, int y, int k) {
        const int dx = x % 16 - 8, dy = y % 16 - 7;
        return 20 + 3 * ((x * 7 + y * 5) % 4) + (dx * dx + dy * dy < 5 ? 100 - 20 * k : 0);
    });
}

std::string catalogue() {
    std::string text = "id,ra,dec,dist,mag,ci\n";
    for (int i = 0; i < 60; ++i)
        text += fmt::format("{},{:.4f},{:.4f},{:.3f},{:.2f},{:.2f}\n", i + 1, 0.4 * i, -60.0 + 2.0 * i,
                            2.0 + 0.1 * i, 4.0 + 0.05 * i, 0.02 * i);
    return text;
}

/// As prepare writes it, of a picture of 32x16 px.
std::string stars_of_picture() {
    std::string text = "x,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n";
    for (int i = 0; i < 12; ++i) {
        const double x = 3.0 + 2.3 * i, y = 2.0 + (5 * i) % 12;
        text += fmt::format("{},{},{},{},{},{},0.5,1.0,0\n", x, y, x / 32.0, 1.0 - y / 16.0, 0.3 + 0.1 * i,
                            1.2 - 0.05 * i);
    }
    return text;
}

std::string camera_way() {
    std::string text;
    for (int frame = 1; frame <= 9; ++frame)
        text += fmt::format("{} {} 0.8 6.0 {} {} 2.0 {}\n", frame, 0.2 * (frame - 5), -6 + 0.1 * frame,
                            2.0 * (frame - 5), 42 + frame);
    return text;
}

struct Inputs {
    TempFolder folder;
    SetCache sets{folder / "sets"};

    Inputs() {
        folder.file("picture.ppm", small_picture());
        folder.file("small.ppm", sky_picture(8, 6, 0));  // bodies have many splats a texel
        folder.file("shell.ppm", shell());
        folder.file("table.pda", cube_of_splats(200));
        write_native(folder / "native.splats", read_splats(folder.file("other.pda", cube_of_splats(150))));
        folder.file("gaussians.ply", ply_of(capture(60, 1), 1));
        folder.file("catalogue.csv", catalogue());
        folder.file("stars.csv", stars_of_picture());
        folder.file("way.chan", camera_way());
        folder.file("sky.ppm", sky_picture(32, 16, 0));
        for (int i = 0; i < 6; ++i) folder.file(fmt::format("face{}.ppm", i), sky_picture(8, 8, i));
        folder.file("field.ppm", deep_field());
    }
};

const Inputs& inputs() {
    static const Inputs made;
    return made;
}

}  // namespace

fs::path input(const std::string& name) { return inputs().folder / name; }

const SetCache& shared_sets() { return inputs().sets; }

}  // namespace astrosplat::test
