// Steps that all formats of frames share, before each goes its own way.
#include "output/write.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/error.h"
#include "core/hash.h"
#include "output/frame_formats.h"

namespace astrosplat {
namespace {

void check_finite(const Image& image, const char* what) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (!std::isfinite(image.pixels[i]))
            throw std::logic_error(fmt::format("a value of the {} image is not finite (value {})", what, i));
}

void check_frame(const RenderedFrame& frame, const OutputParams& output) {
    check_finite(frame.beauty, "beauty");
    if (output.holds("depth")) check_finite(frame.depth, "depth");
    if (output.holds("coverage")) check_finite(frame.coverage, "coverage");
    if (output.holds("count")) check_finite(frame.count, "count");
    if (!output.holds("layers")) return;
    for (const Image& layer : frame.layers) check_finite(layer, "layer");
}

void make_folder(const fs::path& file) {
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    if (error)
        throw OutputError(fmt::format("{}: its folder cannot be made: {}", file.string(), error.message()));
}

}  // namespace

void write_frame(const FrameFile& target, const RenderedFrame& frame, const FrameMetadata& metadata) {
    const FrameFormat format = resolve_format(target.output, target.file);
    check_frame(frame, target.output);
    make_folder(target.file);
    frame_file_formats[std::size_t(format.kind)].write(target, format, frame, metadata);
}

std::string pixel_hash(const Image& image) {
    return Sha256().add(image.pixels.data(), image.pixels.size() * sizeof(float)).hex();
}

}  // namespace astrosplat
