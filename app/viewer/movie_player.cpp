#include "viewer/movie_player.h"

#include <fmt/format.h>

#include "core/error.h"

namespace astrosplat {
namespace {

constexpr int most_side = 1280;  // px; every frame goes to the GPU as floats

std::vector<std::string> playing_command(const fs::path& movie, glm::ivec2 size_px) {
    std::vector<std::string> words = {"ffmpeg", "-loglevel", "quiet", "-re", "-stream_loop", "-1"};
    words.insert(words.end(), {"-i", movie.string(), "-an", "-vf"});
    words.push_back(fmt::format("scale={0}:{1}:force_original_aspect_ratio=decrease,pad={0}:{1}:-1:-1",
                                size_px.x, size_px.y));
    words.insert(words.end(), {"-f", "rawvideo", "-pix_fmt", "rgb24", "-"});
    return words;
}

}  // namespace

void MoviePlayer::want(const fs::path& movie, glm::ivec2 fit_px) {
    if (movie != movie_) {
        process_.reset();
        image_.clear();
        bytes_.clear();
        movie_ = movie;
        const int side = std::max({fit_px.x, fit_px.y, 1});
        size_px_ = glm::max(fit_px * std::min(side, most_side) / side, glm::ivec2(2));
        if (!movie.empty()) process_.emplace(playing_command(movie, size_px_));
    }
    if (!process_) return;
    constexpr int most_ms = 20;  // a frame that has begun comes as fast as it is copied
    const std::size_t size = 3 * static_cast<std::size_t>(size_px_.x) * static_cast<std::size_t>(size_px_.y);
    const bool goes_on = process_->read_up_to(size, most_ms, bytes_);
    if (bytes_.size() == size) {
        PackedImage frame;
        frame.width = size_px_.x;
        frame.height = size_px_.y;
        frame.codes.assign(bytes_.begin(), bytes_.end());
        bytes_.clear();
        image_.show(std::make_shared<const PackedImage>(std::move(frame)), to_image);
    } else if (!goes_on) {
        process_.reset();
        if (!image_.found()) throw OutputError(movie.string() + ": cannot be played by ffmpeg");
    }
}

}  // namespace astrosplat
