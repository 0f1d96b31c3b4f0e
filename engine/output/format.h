// The format of a frame file: [output] with every "auto" resolved for the file's ending.
#pragma once

#include <filesystem>
#include <memory>

#include "scene/scene.h"

namespace astrosplat {

enum class FrameKind { exr, tif, png };

struct FrameFormat {
    FrameKind kind = FrameKind::exr;
    OutputParams::Depth depth = OutputParams::Depth::half_float;             // never automatic
    OutputParams::Compression compression = OutputParams::Compression::zip;  // never automatic; unused by png
    OutputParams::Alpha alpha = OutputParams::Alpha::premultiplied;          // never automatic
    OutputParams::View view = OutputParams::View::linear;                    // never automatic
    OutputParams::Primaries primaries = OutputParams::Primaries::rec709;     // rec709 in all but exr
    double exposure = 0.0;                         // stops; 0 in files that hold scene light
    std::shared_ptr<const DisplayTransform> ocio;  // in place of `view`; null: none

    /// 8 and 16 bit files hold a view of the scene; exr and float tif hold the scene's own light.
    bool holds_view() const {
        return depth == OutputParams::Depth::uint8 || depth == OutputParams::Depth::uint16;
    }
};

/// Throws InputError, one line, when ending, depth, compression, primaries or aovs do not fit together, or
/// the view cannot be made (OcioError, where it is one of the names).
FrameFormat resolve_format(const OutputParams& output, const std::filesystem::path& file);

/// Throws InputError when the settings do not fit the format ("aovs need exr", "png knows 8 and 16 bits"),
/// with the place of the key where it is known.
void check_output(const OutputParams& output, const Places& places = {});

}  // namespace astrosplat
