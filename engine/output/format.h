// The format of a frame file: [output] with every "auto" resolved for the file's ending; and scene light as
// the numbers that a file of that format stores: alpha rule, exposure, view transform, dither and rounding.
#pragma once

#include "core/image.h"
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
FrameFormat resolve_format(const OutputParams& output, const fs::path& file);

/// Throws InputError when the settings do not fit the format ("aovs need exr", "png knows 8 and 16 bits"),
/// with the place of the key where it is known.
void check_output(const OutputParams& output, const Places& places = {});

/// One channel value through a view: linear and srgb clamp to [0, 1]; soft is x(2.51x + 0.03)/(x(2.43x +
/// 0.59) + 0.14) (Narkowicz' fit of the ACES curve), then srgb. Negative values and NaN give 0.
float apply_view(OutputParams::View view, float value);

/// Threshold in (-1/2, 1/2) that is added before rounding to 8 bits: a low-discrepancy lattice
/// (Roberts' R2 sequence in 32-bit fixed point), shifted per channel, a function of the pixel's place
/// in the whole frame.
float dither(std::int64_t x, std::int64_t y, int channel);

/// Channels a file of this format holds: 3 without alpha, else 4.
int stored_channels(const FrameFormat& format);

/// RGBA (premultiplied) as the file holds it, as floats: colour over black (none), divided by alpha
/// (straight), or premultiplied; in files that hold a view the view is applied to the straight colour, so
/// that soft edges keep their colour, and premultiplied again afterwards. Colour without alpha cannot be
/// stored straight: it becomes 0.
void encode_pixel(const FrameFormat& format, float gain, const float* rgba, float* stored);

/// Interleaved 8 or 16 bit samples of an image whose upper left pixel is (x0, y0) of the whole.
std::vector<std::uint8_t> encode_8bit(const FrameFormat& format, const Image& image, std::int64_t x0,
                                      std::int64_t y0);
std::vector<std::uint16_t> encode_16bit(const FrameFormat& format, const Image& image);

/// Interleaved floats with stored_channels(format) channels: scene light in the format's primaries, alpha
/// rule applied.
Image encode_float(const FrameFormat& format, const Image& image);

}  // namespace astrosplat
