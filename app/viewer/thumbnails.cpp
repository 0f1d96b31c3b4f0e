// One thread reads, the window asks.
#include "viewer/thumbnails.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/color.h"
#include "core/log.h"
#include "viewer/small_picture.h"

namespace astrosplat {
namespace {

std::uint8_t byte_of(float value, bool light) {
    const float shown = light ? display_srgb(value) : std::clamp(value, 0.0f, 1.0f);
    return static_cast<std::uint8_t>(std::lround(255.0f * shown));
}

}  // namespace

Thumbnail thumbnail_of_file(const std::filesystem::path& file, std::int64_t most_px,
                            const Progress& progress) {
    const SmallPicture small = read_small_picture(file, most_px, progress);
    Thumbnail made{small.width, small.height, small.image.width, small.image.height, {}};
    made.rgb.reserve(static_cast<std::size_t>(3 * made.small_width * made.small_height));
    for (std::size_t i = 0; i < small.image.pixels.size(); ++i)
        if (i % 4 < 3) made.rgb.push_back(byte_of(small.image.pixels[i], small.light));
    return made;
}

Image to_image(const Thumbnail& thumbnail) {
    Image image = make_image(thumbnail.small_width, thumbnail.small_height, 4, 1.0f);
    for (std::size_t i = 0; i < thumbnail.rgb.size(); ++i)
        image.pixels[i / 3 * 4 + i % 3] = static_cast<float>(thumbnail.rgb[i]) * (1.0f / 255.0f);
    return image;
}

Thumbnails::Thumbnails(std::int64_t most_px, std::size_t most_bytes)
    : most_px_(most_px), most_bytes_(most_bytes) {}

void Thumbnails::want(const std::vector<ListedPicture>& pictures) {
    {
        const auto held = worker_.lock();
        ++calls_;
        wanted_ = pictures;
        std::ranges::stable_sort(wanted_, {}, &ListedPicture::bytes);
        for (const ListedPicture& picture : wanted_)
            if (const auto kept = kept_.find(picture); kept != kept_.end()) kept->second.wanted = calls_;
        if (reading_ && std::ranges::find(wanted_, *reading_) == wanted_.end()) *cancelled_ = true;
        forget_some();
    }
    worker_.wake();
}

std::shared_ptr<const Thumbnail> Thumbnails::found(const ListedPicture& picture) const {
    const auto held = worker_.lock();
    const auto kept = kept_.find(picture);
    return kept == kept_.end() ? nullptr : kept->second.thumbnail;
}

bool Thumbnails::working() const {
    const auto held = worker_.lock();
    return std::ranges::any_of(wanted_, [&](const ListedPicture& picture) { return !kept_.count(picture); });
}

Worker::Task Thumbnails::next_task() {
    const auto next =
        std::ranges::find_if(wanted_, [&](const ListedPicture& picture) { return !kept_.count(picture); });
    if (next == wanted_.end()) return {};
    reading_ = *next;
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    return [this, picture = *next, cancelled = cancelled_] { read(picture, *cancelled); };
}

void Thumbnails::read(const ListedPicture& picture, const std::atomic<bool>& cancelled) {
    const QuietLog quiet;
    auto thumbnail = std::make_shared<Thumbnail>();
    bool done = true;
    try {
        *thumbnail = thumbnail_of_file(picture.file, most_px_, Progress{{}, &cancelled});
    } catch (const Cancelled&) {
        done = false;
    } catch (const std::exception&) {  // whoever opens it is told why
        *thumbnail = {};
    }
    const auto held = worker_.lock();
    reading_.reset();
    if (done) kept_[picture] = {std::move(thumbnail), calls_};
    forget_some();
}

/// Those that were not wanted for longest, until the rest fits; never those wanted now.
void Thumbnails::forget_some() {
    const auto size = [](const Kept& kept) { return sizeof(Thumbnail) + kept.thumbnail->rgb.size(); };
    std::size_t bytes = 0;
    for (const auto& [picture, kept] : kept_) bytes += size(kept);
    while (bytes > most_bytes_) {
        const auto oldest =
            std::ranges::min_element(kept_, {}, [](const auto& entry) { return entry.second.wanted; });
        if (std::ranges::find(wanted_, oldest->first) != wanted_.end()) return;
        bytes -= size(oldest->second);
        kept_.erase(oldest);
    }
}

}  // namespace astrosplat
