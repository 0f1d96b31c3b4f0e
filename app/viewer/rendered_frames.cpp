#include "viewer/rendered_frames.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/gtc/packing.hpp>

#include "viewer/small_picture.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr float half_max = 65504.0f;

FrameOnDisk read_frame(const fs::path& file, std::int64_t most_px) {
    FrameOnDisk frame;
    try {
        const SmallPicture small = read_small_picture(file, most_px);
        frame.width = small.image.width;
        frame.height = small.image.height;
        const auto values = static_cast<std::size_t>(3 * frame.width * frame.height);
        if (small.light)
            frame.light.resize(values);
        else
            frame.codes.resize(values);
        for (std::size_t i = 0; i < values; ++i) {
            const float value = small.image.pixels[i / 3 * 4 + i % 3];
            if (small.light)
                frame.light[i] = glm::packHalf1x16(std::clamp(value, -half_max, half_max));
            else
                frame.codes[i] =
                    static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
        }
    } catch (const std::exception& error) {
        frame.error = error.what();
    }
    return frame;
}

}  // namespace

Image to_image(const FrameOnDisk& frame) {
    Image image = make_image(frame.width, frame.height, 4, 1.0f);
    for (std::size_t i = 0; i < frame.codes.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = static_cast<float>(frame.codes[i]) * (1.0f / 255.0f);
    for (std::size_t i = 0; i < frame.light.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = glm::unpackHalf1x16(frame.light[i]);
    return image;
}

RenderedFrames::RenderedFrames(std::int64_t most_px, std::size_t most_bytes)
    : most_px_(most_px), most_bytes_(most_bytes) {}

void RenderedFrames::want(const std::vector<fs::path>& files) {
    {
        const auto held = worker_.lock();
        wanted_.clear();
        for (const fs::path& file : files) {
            std::error_code missing;
            const fs::file_time_type written = fs::last_write_time(file, missing);
            if (missing) {
                kept_.erase(file);
                continue;
            }
            wanted_.push_back(file);
            Kept& kept = kept_[file];
            if (kept.written != written) kept = {written, nullptr};
        }
        forget_some();
    }
    worker_.wake();
}

std::shared_ptr<const FrameOnDisk> RenderedFrames::found(const fs::path& file) const {
    const auto held = worker_.lock();
    const auto kept = kept_.find(file);
    return kept == kept_.end() ? nullptr : kept->second.frame;
}

bool RenderedFrames::working() const {
    const auto held = worker_.lock();
    return std::ranges::any_of(wanted_, [&](const fs::path& file) { return !kept_.at(file).frame; });
}

Worker::Task RenderedFrames::next_task() {
    for (const fs::path& file : wanted_)
        if (const Kept& kept = kept_.at(file); !kept.frame)
            return [this, file, written = kept.written] { read(file, written); };
    return {};
}

void RenderedFrames::read(const fs::path& file, fs::file_time_type written) {
    auto frame = std::make_shared<const FrameOnDisk>(read_frame(file, most_px_));
    const auto held = worker_.lock();
    const auto kept = kept_.find(file);
    if (kept != kept_.end() && kept->second.written == written) kept->second.frame = std::move(frame);
}

/// Those that are not wanted now, until the rest fits.
void RenderedFrames::forget_some() {
    std::size_t bytes = 0;
    for (const auto& [file, kept] : kept_) bytes += kept.frame ? kept.frame->bytes() : 0;
    for (auto kept = kept_.begin(); kept != kept_.end() && bytes > most_bytes_;) {
        if (std::ranges::find(wanted_, kept->first) != wanted_.end()) {
            ++kept;
            continue;
        }
        bytes -= kept->second.frame ? kept->second.frame->bytes() : 0;
        kept = kept_.erase(kept);
    }
}

}  // namespace astrosplat
