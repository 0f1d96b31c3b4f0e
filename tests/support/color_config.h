// A small configuration of OpenColorIO whose views are closed forms: Film is a matrix and a square root,
// Plain the light itself, Negative one minus it by a table in a file, Pure (of another display)
// the first again.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace astrosplat::test {

inline const char* const color_config_text = R"(ocio_profile_version: 2
search_path: .
strictparsing: true
roles:
  scene_linear: light
  default: light
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Screen:
    - !<View> {name: Film, colorspace: film}
    - !<View> {name: Plain, colorspace: light}
    - !<View> {name: Negative, colorspace: negative}
  Projector:
    - !<View> {name: Pure, colorspace: light}
active_displays: [Screen, Projector]
colorspaces:
  - !<ColorSpace>
    name: light
    bitdepth: 32f
  - !<ColorSpace>
    name: film
    bitdepth: 32f
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.75, 0.25, 0, 0, 0.125, 0.75, 0.125, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: negative
    bitdepth: 32f
    from_scene_reference: !<FileTransform> {src: negative.cube, interpolation: linear}
  - !<ColorSpace>
    name: doubled
    bitdepth: 32f
    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
)";

/// The configuration in this folder, with its table.
inline fs::path write_color_config(const fs::path& folder) {
    std::ofstream(folder / "colors.ocio") << color_config_text;
    std::ofstream table(folder / "negative.cube");
    table << "LUT_3D_SIZE 33\n";
    for (int b = 32; b >= 0; --b)
        for (int g = 32; g >= 0; --g)
            for (int r = 32; r >= 0; --r) table << r / 32.0 << " " << g / 32.0 << " " << b / 32.0 << "\n";
    return folder / "colors.ocio";
}

/// Film's code for light of 0 or more.
inline std::array<double, 3> film(double r, double g, double b) {
    const auto shown = [](double x) { return std::fmin(std::sqrt(x), 1.0); };
    return {shown(0.75 * r + 0.25 * g), shown(0.125 * r + 0.75 * g + 0.125 * b), shown(b)};
}

}  // namespace astrosplat::test
