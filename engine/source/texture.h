// Pictures as splat colours: any file OpenImageIO reads, and FITS through CFITSIO. In: one path, or three for
// r, g, b. Out: Texture, linear light, premultiplied, filtered premultiplied and divided by alpha after
// filtering.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "source/mesh.h"
#include "source/source.h"

namespace astrosplat {

struct Texture {
    Image image;  // RGBA, linear, premultiplied; row 0 is the top (v = 1)
    TextureSettings::Filter filter = TextureSettings::Filter::bilinear;
    TextureSettings::Wrap wrap = TextureSettings::Wrap::clamp;  // never automatic once loaded
    bool divided =
        false;  // colours were divided by alpha (derived or associated alpha): the look need not do it again
    std::string
        credit;  // from the file's own metadata (XMP/AVM credit, EXIF artist, copyright), may be empty
    std::string summary;  // one line for messages: size, HDU, limits and stretch chosen
};

/// Straight colour and alpha at one place of a picture.
struct TextureSample {
    glm::vec3 color;  // linear, straight; 0 where alpha is 0
    float alpha;      // 0..1
};

/// `default_wrap` is what Wrap::automatic means here. Throws InputError, Cancelled.
Texture load_texture(const std::vector<std::filesystem::path>& files, const TextureSettings& settings,
                     TextureSettings::Wrap default_wrap, const Progress& progress = {});

/// Reads a picture without any colour or alpha treatment, for thickness maps: RGB as stored (0..1 for
/// integers), row 0 on top. Throws InputError.
Image load_raw_image(const std::filesystem::path& file);

/// Reads a picture as linear light, premultiplied RGBA, for comparisons. Throws InputError, Cancelled.
Image load_linear_image(const std::filesystem::path& file, const Progress& progress = {});

/// The same for environments: one picture, or the six faces (+x -x +y -y +z -z) of an OpenEXR cube map.
std::vector<Image> load_environment_pictures(const std::filesystem::path& file,
                                             const Progress& progress = {});

/// Filtered lookup at uv (v = 0 is the bottom row). `box_texels` is the side, in texels along u and v, of the
/// box averaged by Filter::area; the other filters ignore it. Alpha of exactly 0 comes back as exactly 0.
TextureSample sample(const Texture& texture, glm::vec2 uv, glm::vec2 box_texels = glm::vec2(0.0f));

/// The built-in "relief": the plane of the texture's aspect, lifted towards +y by the smoothed brightness of
/// the picture; `height` is a fraction of the plane's width. 256 cells along the longer side.
Mesh relief_mesh(const Texture& texture, double height);

}  // namespace astrosplat
