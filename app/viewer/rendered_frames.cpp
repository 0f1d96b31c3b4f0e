#include "viewer/rendered_frames.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "viewer/finished_frames.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

RenderedFrame8 read_frame(const fs::path& file, std::int64_t most_px) {
    RenderedFrame8 frame;
    try {
        const Image image = finished_view(file, most_px).image;
        frame.width = image.width;
        frame.height = image.height;
        frame.rgba.reserve(static_cast<std::size_t>(4 * image.width * image.height));
        for (std::int64_t y = 0; y < image.height; ++y)
            for (std::int64_t x = 0; x < image.width; ++x)
                for (int c = 0; c < 4; ++c)
                    frame.rgba.push_back(static_cast<std::uint8_t>(std::lround(255.0f * image.at(x, y)[c])));
    } catch (const std::exception& error) {
        frame.error = error.what();
    }
    return frame;
}

}  // namespace

Image to_image(const RenderedFrame8& frame) {
    Image image = make_image(frame.width, frame.height, 4, 1.0f);
    std::size_t i = 0;
    for (std::int64_t y = 0; y < frame.height; ++y)
        for (std::int64_t x = 0; x < frame.width; ++x)
            for (int c = 0; c < 4; ++c)
                image.at(x, y)[c] = static_cast<float>(frame.rgba[i++]) * (1.0f / 255.0f);
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

std::shared_ptr<const RenderedFrame8> RenderedFrames::found(const fs::path& file) const {
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
    auto frame = std::make_shared<const RenderedFrame8>(read_frame(file, most_px_));
    const auto held = worker_.lock();
    const auto kept = kept_.find(file);
    if (kept != kept_.end() && kept->second.written == written) kept->second.frame = std::move(frame);
}

/// Those that are not wanted now, until the rest fits.
void RenderedFrames::forget_some() {
    std::size_t bytes = 0;
    for (const auto& [file, kept] : kept_) bytes += kept.frame ? kept.frame->rgba.size() : 0;
    for (auto kept = kept_.begin(); kept != kept_.end() && bytes > most_bytes_;) {
        if (std::ranges::find(wanted_, kept->first) != wanted_.end()) {
            ++kept;
            continue;
        }
        bytes -= kept->second.frame ? kept->second.frame->rgba.size() : 0;
        kept = kept_.erase(kept);
    }
}

}  // namespace astrosplat
