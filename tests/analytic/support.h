// Shared by the end-to-end tests: textures written texel by texel, scenes given as TOML text, rendered
// frames, and frame files read back channel by channel.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"
#include "pipeline.h"
#include "scene/scene.h"
#include "support/temp_folder.h"

namespace astrosplat::analytic {

/// Value of the texel in column x, row y from the top: red, green, blue (straight), alpha.
using Texels = std::function<glm::vec4(int x, int y)>;

/// Float TIFF with unassociated alpha: linear light, stored as it is.
void write_float_tiff(const fs::path& file, int width, int height, const Texels& texels);

/// 8-bit PNG, values 0..1 of the file's own encoding (sRGB), alpha unassociated as always in PNG.
void write_png(const fs::path& file, int width, int height, const Texels& texels);

/// A picture file as it lies on the disk: every channel as floats, with names and types.
struct StoredFile {
    Image image;
    std::vector<std::string> names, types;  // "R", "half"

    /// One channel's value; a name that is not there is a failure of the test (std::out_of_range).
    float at(const std::string& name, std::int64_t x, std::int64_t y) const;
};
StoredFile read_stored_file(const fs::path& file);

/// A PDA file of these rows, "x y z red green blue opacity radius" each.
std::string pda(const std::string& rows);

/// The scene this text describes, its paths relative to the folder.
Scene scene_of(const TempFolder& folder, const std::string& toml);

/// The whole way: text -> scene -> sets -> look -> picture, with the settings of [output].
RenderedFrame render_text(const TempFolder& folder, const std::string& toml, double frame = 1.0);
RenderedFrame render_frame(Pipeline& pipeline, double frame = 1.0);

/// Renders frame 1 and writes it to output.path, in the folder, as batch does.
fs::path write_text(const TempFolder& folder, const std::string& toml);

/// Mean of each channel over a part of an RGBA picture; all of it when the part is empty.
glm::dvec4 mean(const Image& image, Region part = {});

}  // namespace astrosplat::analytic
