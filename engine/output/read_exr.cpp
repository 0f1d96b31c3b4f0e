#include "output/read_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <new>
#include <vector>

#include "output/exr_threads.h"

namespace astrosplat {
namespace {

constexpr int rows_at_once = 256;                             // the most that a compression takes together
constexpr std::int64_t largest_band = std::int64_t{1} << 30;  // bytes; no frame has rows that wide

Region region_of(const Imath::Box2i& window, const Imath::Box2i& whole) {
    return {std::int64_t{window.min.x} - whole.min.x, std::int64_t{window.min.y} - whole.min.y,
            std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1};
}

/// Values of one channel are asked for; OpenEXR unpacks all channels of a row for them.
bool read_all(Imf::InputFile& in) {
    const Imath::Box2i& window = in.header().dataWindow();
    const auto channel = in.header().channels().begin();
    if (channel == in.header().channels().end()) return false;
    constexpr std::size_t value_bytes = 4;
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    if (width * rows_at_once * std::int64_t{value_bytes} > largest_band) return false;
    std::vector<char> band(static_cast<std::size_t>(width) * rows_at_once * value_bytes);
    for (std::int64_t y = window.min.y; y <= window.max.y; y += rows_at_once) {
        Imf::FrameBuffer buffer;
        char* const origin =
            band.data() - (y * width + window.min.x) * static_cast<std::int64_t>(value_bytes);
        buffer.insert(channel.name(), Imf::Slice(channel.channel().type, origin, value_bytes,
                                                 value_bytes * static_cast<std::size_t>(width)));
        in.setFrameBuffer(buffer);
        in.readPixels(static_cast<int>(y),
                      static_cast<int>(std::min<std::int64_t>(y + rows_at_once - 1, window.max.y)));
    }
    return true;
}

/// `answer` of an open file; `otherwise` where it is none that OpenEXR can read.
template <class Answer, class Result>
Result ask(const std::filesystem::path& file, const Answer& answer, Result otherwise) try {
    Imf::InputFile in(file.c_str(), exr_threads());
    return answer(in);
} catch (const std::bad_alloc&) {
    throw;
} catch (const std::exception&) {
    return otherwise;
}

}  // namespace

std::optional<StoredHeader> read_exr_header(const std::filesystem::path& file) {
    const auto header_of = [](const Imf::InputFile& in) {
        const Imf::Header& from = in.header();
        const Region whole = region_of(from.displayWindow(), from.displayWindow());
        StoredHeader header{whole.width, whole.height, {}, {}, from.compression() == Imf::DWAA_COMPRESSION};
        if (from.dataWindow() != from.displayWindow())
            header.region = region_of(from.dataWindow(), from.displayWindow());
        for (auto attribute = from.begin(); attribute != from.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute())) {
                const std::string& padded = text->value();  // write_exr.cpp pads long ones
                header.texts.emplace(attribute.name(), padded.substr(0, padded.find_last_not_of(' ') + 1));
            }
        return std::optional(header);
    };
    return ask(file, header_of, std::optional<StoredHeader>());
}

bool exr_is_whole(const std::filesystem::path& file) { return ask(file, read_all, false); }

}  // namespace astrosplat
