// The card's memory: buffers, splats that are kept from frame to frame, and how much all of it may take.
#include <fmt/format.h>

#include <cstring>

#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "gl/card_parts.h"
#include "splats/splat_set.h"

namespace astrosplat {

using namespace card;

namespace {

constexpr GLuint sorted = 4096;
constexpr std::uint64_t frames_kept = 64;  // splats that so many draws did not ask for give their memory back

/// What tells how many KiB of the card's memory are free, by extensions of NVIDIA's and AMD's drivers; 0:
/// none.
GLenum free_memory_query() {
    constexpr std::pair<const char*, GLenum> queries[] = {{"GL_NVX_gpu_memory_info", 0x9049},
                                                          {"GL_ATI_meminfo", 0x87FC}};
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i)
        for (const auto& [name, query] : queries) {
            const auto* has = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i)));
            if (has && std::strcmp(has, name) == 0) return query;
        }
    return 0;
}

/// Cubics as the fold reads them, [node][segment] by powers, and three times four moments a node.
void lay_out(const FootprintTable& table, std::vector<float>& nodes, std::vector<float>& moments) {
    for (const FootprintNode& node : table.nodes) {
        for (int s = 0; s < FootprintNode::segments; ++s)
            for (const auto& power : node.cubic) nodes.push_back(power[s]);
        moments.insert(moments.end(), &node.moments.mean, &node.moments.mean + 12);
    }
}

}  // namespace

bool CardBuffer::reserve(std::int64_t bytes, GLbitfield flags) {
    if (bytes <= bytes_) return true;
    buffer_.reset();
    bytes_ = 0;
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR;) ++i;  // a lost context has no end of them
    GLuint name = 0;
    glBindBuffer(GL_COPY_WRITE_BUFFER, name = buffer_.get());
    glBufferStorage(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, flags);
    if (glGetError() != GL_NO_ERROR) {
        buffer_.reset();
        return false;
    }
    bytes_ = bytes;
    return true;
}

bool CardBuffer::fill(const void* data, std::int64_t bytes) {
    if (!reserve(std::max<std::int64_t>(bytes, 16))) return false;
    glNamedBufferSubData(name(), 0, static_cast<GLsizeiptr>(bytes), data);
    return true;
}

/// Fills a buffer by way of memory that card and processor share, which all threads copy into: some ten times
/// as fast as a plain call (1 GB/s on an H100). In two halves, of which one is written while the other is on
/// its way.
bool Card::send(const void* data, std::int64_t bytes, CardBuffer& to) {
    constexpr std::int64_t half = 32 << 20, chunk = 1 << 20;
    constexpr GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    if (bytes < half) return to.fill(data, bytes);
    if (!to.reserve(bytes)) return false;
    if (!sent_) {
        if (!sending_.reserve(2 * half, flags | GL_CLIENT_STORAGE_BIT)) return false;
        sent_ = static_cast<std::byte*>(glMapNamedBufferRange(sending_.name(), 0, 2 * half, flags));
        if (!sent_) return false;
    }
    GLsync on_its_way[2] = {};
    for (std::int64_t at = 0, n = 0; at < bytes; at += half, ++n) {
        GLsync& sync = on_its_way[n % 2];
        if (sync) glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, ~GLuint64{0});
        glDeleteSync(sync);
        const std::int64_t size = std::min(half, bytes - at), place = n % 2 * half;
        parallel_chunks(size, chunk, [&](std::int64_t begin, std::int64_t end, int) {
            std::memcpy(sent_ + place + begin, static_cast<const std::byte*>(data) + at + begin,
                        static_cast<std::size_t>(end - begin));
        });
        glCopyNamedBufferSubData(sending_.name(), to.name(), place, at, size);
        sync = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    }
    for (const GLsync sync : on_its_way) {
        if (sync) glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, ~GLuint64{0});
        glDeleteSync(sync);
    }
    return true;
}

Card::Card(const GlInfo& info, bool native_division) : info_(info), native_division_(native_division) {
    if (info.major * 10 + info.minor < 45)
        throw NoContext(fmt::format("{} has OpenGL {}.{}, and 4.5 is needed to draw exactly", info.renderer,
                                    info.major, info.minor));
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    most_bytes_ = std::min<std::int64_t>(bytes, 0x7fffffff);
    free_memory_ = free_memory_query();
}

std::int64_t Card::free_bytes() const {
    GLint kib[4] = {};
    if (free_memory_ != 0) glGetIntegerv(free_memory_, kib);
    return std::int64_t{kib[0]} << 10;
}

/// Bytes that all buffers may take.
std::int64_t Card::room() {
    if (room_ > 0) return room_;
    return free_memory_ != 0 ? bytes() + free_bytes() : std::numeric_limits<std::int64_t>::max();
}

std::int64_t Card::bytes() {
    std::int64_t sum = 0;
    for (const CardBuffer* const buffer : working()) sum += buffer->bytes();
    for (const CardBuffer* buffer : {&layers_, &nodes_, &moments_, &cosines_, &given_splats_, &given_shapes_})
        sum += buffer->bytes();
    for (const auto& [layer, children] : children_) sum += children.bytes();
    for (const auto& [key, kept] : kept_)
        for (const CardBuffer& array : kept.arrays) sum += array.bytes();
    for (const auto& [key, kept] : sets_)
        for (const CardBuffer& array : kept.arrays) sum += array.bytes();
    return sum;
}

/// The buffers that each group fills anew.
std::vector<CardBuffer*> Card::working() {
    std::vector<CardBuffer*> buffers = {&counts_, &arguments_, &begins_,  &entry_begins_, &records_,
                                        &tags_,   &rects_,     &ranks_,   &digits_,       &sums_,
                                        &ranges_, &light_,     &through_, &more_,         &layer_light_};
    for (auto* list : {&keys_, &values_})
        for (CardBuffer& buffer : *list) buffers.push_back(&buffer);
    return buffers;
}

/// What is not needed yet, or was for other frames, gives way.
bool Card::make_room(std::int64_t bytes_more) {
    const auto has_room = [&] { return bytes() + bytes_more <= room(); };
    if (has_room()) return true;
    std::erase_if(kept_, [&](const auto& other) { return other.second.frame < frames_; });
    std::erase_if(sets_, [&](const auto& other) { return other.second.frame < frames_; });
    for (CardBuffer* const buffer : working()) buffer->release();
    children_.clear();
    return has_room();
}

/// Memory for so many records and entries at a time. False where there is not so much.
bool Card::reserve(const FrameJob& job, const Group& group, std::int64_t records, std::int64_t entries) {
    const std::int64_t n = std::max<std::int64_t>(records, 1),
                       tiles = std::int64_t(group.columns) * group.rows, record_bytes = group.any ? 64 : 32;
    entries = std::max(n, entries) + sorted;
    const std::int64_t begins = group.splat_groups * std::int64_t(group.slabs) + 1,
                       blocks = groups_for(std::max(entries, keys_[0].bytes() / 4), sorted) + 1;
    const bool carries = !group.alone || group.slabs > 1;  // what is not light
    std::vector<std::pair<CardBuffer*, std::int64_t>> wanted = {
        {&counts_, sizeof(Counts)},
        {&arguments_, 3 * 4 * 8},
        {&begins_, 4 * begins},
        {&entry_begins_, 4 * (groups_for(n, group_size) + 1)},
        {&records_, record_bytes * n},
        {&tags_, group.any ? 8 * n : 16},
        {&rects_, 8 * n},
        {&ranks_, group.ranked ? 4 * n : 16},
        {&digits_, 4 * 256 * blocks},
        {&sums_, 4 * (std::max(256 * blocks, begins) / scanned + 64)},
        {&ranges_, 4 * tiles * (group.slabs + 1)},
        {&light_, 16 * group.pixels},
        {&through_, carries ? 16 * group.pixels : 16},
        {&more_, carries && group.any ? 16 * group.pixels : 16},
        {&layer_light_, job.settings.aov_layers ? 16 * group.pixels * std::ssize(job.layers) : 16}};
    for (int i = 0; i < (group.ranked ? 4 : 3); ++i)
        for (CardBuffer* buffer : {&keys_[i], &values_[i]})
            wanted.emplace_back(buffer, 4 * (i < 2 ? entries : n));
    std::int64_t sum = bytes();
    for (const auto& [buffer, size] : wanted) {
        if (size > most_bytes_) return false;
        sum += std::max<std::int64_t>(0, size - buffer->bytes());
    }
    if (sum > bytes() && sum > room()) return false;
    if (sum > 2 * told_bytes_)
        log_detail(fmt::format("{} takes {} of the card's memory", human_count(group.count, "splat"),
                               human_bytes(double(sum))));
    told_bytes_ = std::max(told_bytes_, sum);
    return std::ranges::all_of(wanted, [](const auto& want) { return want.first->reserve(want.second); });
}

bool Card::upload_tables(const FrameJob& job, const Group& group) {
    std::vector<float> nodes, moments;
    for (const FootprintTable* table : group.tables) lay_out(*table, nodes, moments);
    struct CardLayer {
        float absorb[4];
        std::int32_t kind[4];
    };
    std::vector<CardLayer> layers;
    for (const FoldLayer& layer : job.fold_layers)
        layers.push_back({{layer.absorb.x, layer.absorb.y, layer.absorb.z, 0.0f},
                          {int(layer.blend), layer.holdout, layer.footprints->linear_in_distance, 0}});
    return nodes_.fill(nodes.data(), 4 * std::ssize(nodes)) &&
           moments_.fill(moments.data(), 4 * std::ssize(moments)) &&
           layers_.fill(layers.data(), std::ssize(layers) * std::int64_t(sizeof(CardLayer))) &&
           cosines_.fill(pixel_cosines.data(), sizeof pixel_cosines);
}

const Card::Kept* Card::keep(const RenderLayer& layer, bool with_ids) {
    std::erase_if(kept_, [&](const auto& kept) { return kept.second.frame + frames_kept < frames_; });
    std::erase_if(sets_, [&](const auto& kept) { return kept.second.frame + frames_kept < frames_; });
    if (layer.on_device) {
        const auto found = kept_.find({layer.on_device->stamp, nullptr});
        if (found == kept_.end()) return nullptr;
        found->second.frame = frames_;
        KeptSet& set = sets_[found->second.set_stamp];
        set.frame = frames_;  // stays for the next look
        found->second.ids = &set.arrays[4];
        return with_ids && set.arrays[4].bytes() == 0 ? nullptr : &found->second;
    }
    const ShadedSplats& splats = *layer.splats;
    // Without a stamp nobody knows whether they are the same.
    const std::pair key{splats.stamp, splats.stamp != 0 ? nullptr : &splats};
    Kept& kept = kept_[key];
    auto& [positions, radii, alphas, colors, ids] = kept.arrays;
    const bool there = splats.stamp != 0 && kept.frame != 0;
    kept.frame = frames_;
    const std::int64_t n = splats.size();
    std::int64_t own = 0;
    for (const CardBuffer& array : kept.arrays) own += array.bytes();
    bool fits =
        there ||
        (make_room(std::max<std::int64_t>(0, 32 * n - own)) &&
         send(splats.position.data(), 12 * n, positions) && send(splats.radius.data(), 4 * n, radii) &&
         send(splats.alpha.data(), 4 * n, alphas) && send(splats.color.data(), 12 * n, colors));
    if (fits && with_ids && !(there && ids.bytes() > 0))
        fits = make_room(8 * n) && send(splats.id.data(), 8 * n, ids);
    kept.ids = ids.bytes() > 0 ? &ids : nullptr;
    if (fits) return &kept;
    kept_.erase(key);
    return nullptr;
}

}  // namespace astrosplat
