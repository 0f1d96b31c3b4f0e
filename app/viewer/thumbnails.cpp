// A picture is read by rows and made small on the way, so that a large one takes time but no memory.
#include "viewer/thumbnails.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/color.h"
#include "core/log.h"
#include "image/area.h"
#include "source/stored_picture.h"

namespace astrosplat {
namespace {

/// Values of a FITS plane that are held at once.
constexpr std::int64_t most_values = std::int64_t{1} << 22;

/// What has no value is black: a gap must not take the light around it.
ImageRows without_gaps(ImageRows rows) {
    const std::int64_t row_values = rows.width * rows.channels;
    rows.read = [row_values, read = std::move(rows.read)](std::int64_t begin, std::int64_t end, float* out) {
        read(begin, end, out);
        std::replace_if(
            out, out + (end - begin) * row_values, [](float value) { return std::isnan(value); }, 0.0f);
    };
    return rows;
}

std::uint8_t byte_of(float value, bool light) {
    const float shown = light ? display_srgb(value) : std::clamp(value, 0.0f, 1.0f);
    return static_cast<std::uint8_t>(std::lround(255.0f * shown));
}

std::int64_t shrunk(std::int64_t length, std::int64_t longer, std::int64_t most_px) {
    return longer <= most_px ? length : std::max<std::int64_t>(1, length * most_px / longer);
}

}  // namespace

Thumbnail thumbnail_of_file(const std::filesystem::path& file, std::int64_t most_px,
                            const Progress& progress) {
    StoredRows from = open_stored(file, TextureSettings{}, progress, most_values);
    const Picture& picture = from.stored.picture;
    Thumbnail made;
    made.width = from.rows.width;
    made.height = from.rows.height;
    const std::int64_t longer = std::max(made.width, made.height);
    made.small_width = shrunk(made.width, longer, most_px);
    made.small_height = shrunk(made.height, longer, most_px);
    const Image small =
        reduced_by_area(without_gaps(std::move(from.rows)), made.small_width, made.small_height);
    progress.check();
    const bool divides = small.channels == 4 && !picture.associated;
    made.rgb.reserve(static_cast<std::size_t>(3 * made.small_width * made.small_height));
    for (std::int64_t i = 0; i < made.small_width * made.small_height; ++i) {
        const float* const p = small.pixels.data() + i * small.channels;
        for (int c = 0; c < 3; ++c)
            made.rgb.push_back(byte_of(divides ? p[c] * p[3] : p[c], !from.stored.display_values));
    }
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
