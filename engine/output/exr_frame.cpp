#include "output/frame_formats.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRationalAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <half.h>

#include <cstring>
#include <new>

#include "core/atomic_file.h"
#include "core/color.h"
#include "core/error.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

/// The threads that OpenEXR may pack and unpack pixels with: as many as the program's own; none where there
/// are none to be had, and it does without.
int exr_threads() try {
    if (Imf::globalThreadCount() != thread_count()) Imf::setGlobalThreadCount(thread_count());
    return Imf::globalThreadCount();
} catch (const std::exception&) {
    return 0;
}

constexpr std::int64_t band_rows = 256;  // a multiple of every compression's block height
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
    if (width * band_rows * std::int64_t{value_bytes} > largest_band) return false;
    std::vector<char> band(std::size_t(width * band_rows) * value_bytes);
    for (std::int64_t y = window.min.y; y <= window.max.y; y += band_rows) {
        Imf::FrameBuffer buffer;
        char* const origin = band.data() - (y * width + window.min.x) * std::int64_t(value_bytes);
        buffer.insert(channel.name(), Imf::Slice(channel.channel().type, origin, value_bytes,
                                                 value_bytes * std::size_t(width)));
        in.setFrameBuffer(buffer);
        in.readPixels(int(y), int(std::min<std::int64_t>(y + band_rows - 1, window.max.y)));
    }
    return true;
}

/// `answer` of an open file; `otherwise` where it is none that OpenEXR can read.
template <class Answer, class Result>
Result ask(const fs::path& file, const Answer& answer, Result otherwise) try {
    Imf::InputFile in(file.c_str(), exr_threads());
    return answer(in);
} catch (const std::bad_alloc&) {
    throw;
} catch (const std::exception&) {
    return otherwise;
}

}  // namespace

std::optional<StoredHeader> read_exr_header(const fs::path& file) {
    const auto header_of = [](const Imf::InputFile& in) {
        const Imf::Header& from = in.header();
        const Region whole = region_of(from.displayWindow(), from.displayWindow());
        StoredHeader header{whole.width, whole.height, {}, {}, from.compression() == Imf::DWAA_COMPRESSION};
        if (from.dataWindow() != from.displayWindow())
            header.region = region_of(from.dataWindow(), from.displayWindow());
        for (auto attribute = from.begin(); attribute != from.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute())) {
                const std::string& padded = text->value();  // padded_for_ffmpeg lengthens long ones
                header.texts.emplace(attribute.name(), padded.substr(0, padded.find_last_not_of(' ') + 1));
            }
        return std::optional(header);
    };
    return ask(file, header_of, std::optional<StoredHeader>());
}

bool exr_is_whole(const fs::path& file) { return ask(file, read_all, false); }

namespace {

constexpr std::size_t piece_bytes = std::size_t{4} << 20;

/// OpenEXR's output to an AtomicFile, collected into large pieces: it writes a frame as hundreds of small
/// ones, and comes back to the table in front of them.
class ExrStream : public Imf::OStream {
  public:
    explicit ExrStream(AtomicFile& file) : OStream(file.target().c_str()), file_(file) {
        piece_.reserve(piece_bytes);
    }

    void write(const char bytes[], int size) override {
        const auto count = std::size_t(size);
        if (piece_.size() + count > piece_bytes) flush();
        piece_.insert(piece_.end(), bytes, bytes + count);
    }

    std::uint64_t tellp() override { return begin_ + piece_.size(); }
    void seekp(std::uint64_t position) override {
        if (position == tellp()) return;
        flush();
        begin_ = position;
    }

    /// Writes what is collected. Throws the first OutputError of all writes, of which some may have been made
    /// where nothing can be thrown.
    void flush() {
        file_.write_at(std::int64_t(begin_), piece_.data(), piece_.size());
        file_.rethrow_failure();  // which OpenEXR swallows where it ends a file
        begin_ += piece_.size();
        piece_.clear();
    }

  private:
    GuardedFile file_;
    std::vector<char> piece_;
    std::uint64_t begin_ = 0;  // of the piece in the file
};

constexpr float largest_half = 65504.0f;

/// One channel: where its floats lie and how they are stored.
struct Channel {
    std::string name;
    const Image* image;
    int index;
    bool half;

    std::int64_t bytes() const { return half ? 2 : 4; }  // of a pixel
};

std::vector<Channel> channels_of(const Image& beauty, const std::vector<Image>& layers,
                                 const RenderedFrame& frame, const FrameFile& target, bool half) {
    const OutputParams& output = target.output;
    static const char* const names[4] = {"R", "G", "B", "A"};
    std::vector<Channel> channels;
    for (int c = 0; c < beauty.channels; ++c) channels.push_back({names[c], &beauty, c, half});
    if (output.holds("depth")) channels.push_back({"Z", &frame.depth, 0, false});
    if (output.holds("coverage")) channels.push_back({"coverage", &frame.coverage, 0, half});
    if (output.holds("count")) channels.push_back({"count", &frame.count, 0, false});
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (int c = 0; c < layers[i].channels; ++c)
            channels.push_back({fmt::format("{}.{}", target.layer_names[i], names[c]), &layers[i], c, half});
    return channels;
}

Imf::Compression compression_of(OutputParams::Compression compression) {
    using Compression = OutputParams::Compression;
    if (compression == Compression::zips) return Imf::ZIPS_COMPRESSION;
    if (compression == Compression::piz) return Imf::PIZ_COMPRESSION;
    if (compression == Compression::dwaa) return Imf::DWAA_COMPRESSION;
    return compression == Compression::none ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
}

Imf::Chromaticities chromaticities_of(OutputParams::Primaries primaries) {
    const bool acescg = primaries == OutputParams::Primaries::acescg;
    const Chromaticities& set = acescg ? acescg_chromaticities : rec709_chromaticities;
    const auto at = [](const glm::dvec2& xy) { return Imath::V2f(float(xy.x), float(xy.y)); };
    return {at(set.red), at(set.green), at(set.blue), at(set.white)};
}

Imath::M44f matrix_of(const float (&values)[16]) {
    Imath::M44f matrix;
    std::copy(values, values + 16, matrix.getValue());
    return matrix;
}

// FFmpeg before 6.1 (libavcodec/exr.c, decode_header) reads 255 bytes of a text and goes on behind them as if
// they were all, in rounds of name, type, size and value of 255 + 1 + 255 + 1 + 4 + 255 bytes, until it has
// eaten the end of the text, and maybe the compression with it. Blanks at the end let it arrive where the
// next attribute begins.
std::string padded_for_ffmpeg(std::string text) {
    constexpr std::size_t portion = 255, round = 771;
    if (text.size() > portion) text.append((round - (text.size() - portion) % round) % round, ' ');
    return text;
}

void set_text(Imf::Header& header, const FrameMetadata& metadata) {
    const auto set = [&](const std::string& name, const std::string& value) {
        header.insert(name, Imf::StringAttribute(padded_for_ffmpeg(value)));
    };
    for (const auto& [name, value] : metadata_entries(metadata)) set(name, value);
    if (!metadata.provenance.credit.empty()) set("owner", metadata.provenance.credit);
    set("xmp", frame_xmp(metadata));  // as OpenImageIO names it
    set("capDate", "");               // no clock
    if (metadata.eye != Eye::centre) set("view", std::string(name_of(metadata.eye)));
}

Imf::Header make_header(const FrameFile& target, const FrameFormat& format, const Image& beauty,
                        const std::vector<Channel>& channels, const FrameMetadata& metadata) {
    const auto box = [](std::int64_t x, std::int64_t y, std::int64_t width, std::int64_t height) {
        return Imath::Box2i({int(x), int(y)}, {int(x + width - 1), int(y + height - 1)});
    };
    Imf::Header header(box(0, 0, target.whole_width, target.whole_height),
                       box(target.region.x, target.region.y, beauty.width, beauty.height));
    header.compression() = compression_of(format.compression);
    const Imf::Compression kind = header.compression();
    // A few per cent larger than 6, and several times as quick.
    if (kind == Imf::ZIP_COMPRESSION || kind == Imf::ZIPS_COMPRESSION) header.zipCompressionLevel() = 4;
    // The usual loss, said in the file: whoever writes it again keeps to it.
    if (kind == Imf::DWAA_COMPRESSION) header.insert("dwaCompressionLevel", Imf::FloatAttribute(45.0f));
    for (const Channel& channel : channels)
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    Imf::addChromaticities(header, chromaticities_of(format.primaries));
    const Rational fps = rational_fps(metadata.fps);
    Imf::addFramesPerSecond(header, Imf::Rational(fps.numerator, fps.denominator));
    if (metadata.matrices) {
        Imf::addWorldToCamera(header, matrix_of(metadata.matrices->world_to_camera));
        Imf::addWorldToNDC(header, matrix_of(metadata.matrices->world_to_ndc));
    }
    set_text(header, metadata);
    return header;
}

/// Some rows of the channels, each channel's one after the other, as they are stored.
class Band {
  public:
    Band(const std::vector<Channel>& channels, std::int64_t rows)
        : channels_(channels), width_(channels[0].image->width) {
        for (const Channel& channel : channels_) {
            places_.push_back(bytes_.size());
            bytes_.resize(bytes_.size() + std::size_t(rows * width_ * channel.bytes()));
        }
    }

    /// Takes rows y0 .. y1 of the images; light beyond half's range stays finite.
    void take(std::int64_t y0, std::int64_t y1) {
        parallel_for(y1 - y0, [&](std::int64_t row, int) {
            for (std::size_t c = 0; c < channels_.size(); ++c) {
                const Channel& channel = channels_[c];
                char* const to = bytes_.data() + places_[c] + row * width_ * channel.bytes();
                const float* const from = channel.image->at(0, y0 + row) + channel.index;
                channel.half ? copy<half>(from, channel, to) : copy<float>(from, channel, to);
            }
        });
    }

    /// The band begins at the file's row y, its columns at x.
    Imf::FrameBuffer frame_buffer(std::int64_t x, std::int64_t y) {
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const Channel& channel = channels_[c];
            char* const origin = bytes_.data() + places_[c] - (y * width_ + x) * channel.bytes();
            buffer.insert(channel.name,
                          Imf::Slice(channel.half ? Imf::HALF : Imf::FLOAT, origin,
                                     std::size_t(channel.bytes()), std::size_t(channel.bytes() * width_)));
        }
        return buffer;
    }

  private:
    template <class Stored>
    void copy(const float* from, const Channel& channel, char* to) const {
        const float limit = channel.half ? largest_half : std::numeric_limits<float>::max();
        for (std::int64_t x = 0; x < width_; ++x, from += channel.image->channels, to += sizeof(Stored)) {
            const Stored stored(std::clamp(*from, -limit, limit));
            std::memcpy(to, &stored, sizeof stored);
        }
    }

    const std::vector<Channel>& channels_;
    std::int64_t width_;
    std::vector<std::size_t> places_;  // of the channels in the bytes
    std::vector<char> bytes_;
};

void write_rows(ExrStream& stream, const Imf::Header& header, const std::vector<Channel>& channels) {
    Imf::OutputFile out(stream, header, exr_threads());
    const std::int64_t height = channels[0].image->height;
    const Imath::Box2i& window = header.dataWindow();
    Band band(channels, std::min(band_rows, height));
    for (std::int64_t y = 0; y < height; y += band_rows) {
        const std::int64_t end = std::min(y + band_rows, height);
        band.take(y, end);
        out.setFrameBuffer(band.frame_buffer(window.min.x, window.min.y + y));
        out.writePixels(int(end - y));
    }
}

}  // namespace

void write_exr(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata) {
    const Image beauty = encode_float(format, frame.beauty);
    std::vector<Image> layers;
    if (target.output.holds("layers"))
        for (const Image& layer : frame.layers) layers.push_back(encode_float(format, layer));
    assert(layers.size() <= target.layer_names.size());
    const bool half = format.depth == OutputParams::Depth::half_float;
    const std::vector<Channel> channels = channels_of(beauty, layers, frame, target, half);
    AtomicFile file(target.file, target.existing);
    ExrStream stream(file);
    try {
        write_rows(stream, make_header(target, format, beauty, channels, metadata), channels);
        stream.flush();
    } catch (const OutputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string reason = error.what();
        std::ranges::replace(reason, '\n', ' ');
        throw OutputError(fmt::format("{}: cannot be written: {}", target.file.string(), reason));
    }
    file.commit();
}

}  // namespace astrosplat
