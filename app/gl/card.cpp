#include "gl/card.h"

#include <fmt/format.h>

#include <cstring>

#include <sstream>

#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "render/shape.h"
#include "splats/splat_set.h"

namespace astrosplat {

namespace {

constexpr GLuint group_size = 256, sorted = 4096, scanned = 2048;
constexpr int tile_px = 16;
constexpr std::int64_t most_px = 32768;  // of a side: 256 splats over all tiles still have countable entries
constexpr std::size_t most_falloffs = 100;  // whose nodes have numbers of 16 bits
// Slabs from so many splats on, of so many each: 256 MB of records of 32 bytes.
constexpr std::int64_t slabs_from = 12'000'000, splats_of_slab = 8'000'000;
constexpr std::uint64_t frames_kept = 64;  // splats that so many draws did not ask for give their memory back
constexpr int segments = FootprintNode::segments;
constexpr double spare = 1.05, most_each = 16.0;  // entries of a splat: the last group's may have been wide
// What is tried, one after the other, until the memory suffices.
constexpr Card::Share shares[] = {{}, {true, 8}, {true, 32}, {false, 0, 4}, {true, 32, 4}, {true, 32, 16}};

void barrier() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void bind(std::initializer_list<const CardBuffer*> buffers) {
    for (GLuint at = 1; const CardBuffer* buffer : buffers) buffer->bind(at++);
}

std::int64_t groups_for(std::int64_t count, std::int64_t each) { return (count + each - 1) / each; }

/// Cubics as the fold reads them, [node][segment] by powers, and three times four moments a node.
void lay_out(const FootprintTable& table, std::vector<float>& nodes, std::vector<float>& moments) {
    for (const FootprintNode& node : table.nodes) {
        for (int s = 0; s < segments; ++s)
            for (const auto& power : node.cubic) nodes.push_back(power[s]);
        moments.insert(moments.end(), &node.moments.mean, &node.moments.mean + 12);
    }
}

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

void set_lens(const Uniforms& set, const Lens& lens) {
    set("lens.projection", lens.projection);
    const std::pair<const char*, float> numbers[] = {{"lens.focal_px", lens.focal_px},
                                                     {"lens.center_x_px", lens.center_x_px},
                                                     {"lens.center_y_px", lens.center_y_px},
                                                     {"lens.near", lens.near},
                                                     {"lens.far", lens.far},
                                                     {"lens.near_fade", lens.near_fade},
                                                     {"lens.edge", lens.edge},
                                                     {"lens.parallax", lens.parallax}};
    for (const auto& [name, value] : numbers) set(name, value);
}

void set_camera(const Uniforms& set, const LayerProjection& layer) {
    double rows[12];
    for (int k = 0; k < 3; ++k) {
        for (int column = 0; column < 3; ++column) rows[4 * k + column] = layer.camera_from_layer[column][k];
        rows[4 * k + 3] = layer.origin_in_camera[k];
    }
    glProgramUniform4dv(set.program, set.at("camera_row"), 3, rows);
}

/// Whether the processor projects all of the layer's splats.
bool is_given(const RenderLayer& layer) {
    return layer.stars || (layer.splats && !layer.splats->stretch.empty());
}

/// The driver does not take one of our programs.
struct CardFailed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

bool is_screen(const FoldLayer& layer) {
    return layer.blend == Blend::screen && !layer.holdout && !layer.absorbs;
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

std::string Card::cannot(const FrameJob& job) const {
    if (lost_) return "it was lost";
    if (shared::is_onto_sphere(job.fold.lens)) return "it draws no projections onto the sphere";
    if (job.region.width > most_px || job.region.height > most_px)
        return "it draws no frames as large as this";
    for (std::size_t g = 0; g < job.groups.size(); ++g) {
        for (const std::size_t l : job.groups[g].layers) {
            if (job.layers[l].blocks) return "it draws no layers that are read block by block";
            if (12 * job.layers[l].size() > most_bytes_) return "it has no buffers for so many splats";
        }
        if (plan(job, g, false, job.region).tables.size() > most_falloffs)
            return "it draws no mix of so many falloffs";
    }
    return {};
}

Card::Group Card::plan(const FrameJob& job, std::size_t number, bool alone, const Region& region) const {
    const BlendGroup& blend = job.groups[number];
    Group group{};
    group.kind = blend.kind;
    group.alone = alone;
    group.region = region;
    group.pixels = region.width * region.height;
    group.columns = static_cast<int>(groups_for(region.width, tile_px));
    group.rows = static_cast<int>(groups_for(region.height, tile_px));
    bool flat = false, screen = blend.kind == FoldKind::general;
    for (const std::size_t l : blend.layers) {
        const FoldLayer& layer = job.fold_layers[l];
        if (std::ranges::find(group.tables, layer.footprints) == group.tables.end())
            group.tables.push_back(layer.footprints);
        flat = flat || layer.footprints->flat_core;
        screen = screen && is_screen(layer);
        group.shaped = group.shaped || is_given(job.layers[l]);
    }
    const bool general = blend.kind == FoldKind::general && !screen;
    group.any = flat || general || group.shaped || job.fold.aovs || group.tables.size() > 1;
    group.screen = screen && !group.any;
    return group;
}

GLuint Card::slabs_for(std::int64_t splats, const Share& share) const {
    std::int64_t slabs = std::max<std::int64_t>(slabs_, share.slabs);
    if (slabs == 0) slabs = splats < slabs_from ? 1 : groups_for(splats, splats_of_slab);
    return static_cast<GLuint>(std::min<std::int64_t>(slabs, most_slabs));
}

/// What is not needed yet, or was for other frames, gives way.
bool Card::make_room(std::int64_t bytes_more) {
    const auto has_room = [&] { return bytes() + bytes_more <= room(); };
    if (has_room()) return true;
    std::erase_if(kept_, [&](const auto& other) { return other.second.frame < frames_; });
    std::erase_if(sets_, [&](const auto& other) { return other.second.frame < frames_; });
    for (CardBuffer* const buffer : working()) buffer->release();
    return has_room();
}

namespace {

/// A bit a splat: whether it is a star.
bool fill_stars(const Buffer<std::uint64_t>& ids, CardBuffer& stars) {
    std::vector<std::uint32_t> bits(ids.size() / 32 + 1);
    for (std::size_t i = 0; i < ids.size(); ++i) bits[i / 32] |= std::uint32_t{is_star(ids[i])} << i % 32;
    return stars.fill(bits.data(), 4 * std::ssize(bits));
}

}  // namespace

const Card::Kept* Card::keep(const RenderLayer& layer, bool with_stars) {
    std::erase_if(kept_, [&](const auto& kept) { return kept.second.frame + frames_kept < frames_; });
    std::erase_if(sets_, [&](const auto& kept) { return kept.second.frame + frames_kept < frames_; });
    if (layer.on_device) {
        const auto found = kept_.find({layer.on_device->stamp, nullptr});
        if (found == kept_.end()) return nullptr;
        found->second.frame = frames_;
        sets_[found->second.set_stamp].frame = frames_;  // stays for the next look
        return &found->second;
    }
    const ShadedSplats& splats = *layer.splats;
    // Without a stamp nobody knows whether they are the same.
    const std::pair key{splats.stamp, splats.stamp != 0 ? nullptr : &splats};
    Kept& kept = kept_[key];
    auto& [positions, radii, alphas, colors, stars] = kept.arrays;
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
    if (fits && with_stars && !(there && stars.bytes() > 0)) fits = fill_stars(splats.id, stars);
    if (fits) return &kept;
    kept_.erase(key);
    return nullptr;
}

/// Those splats of a layer that level of detail divides or that are stars which stay points, ascending.
std::optional<std::vector<std::int64_t>> Card::rest_of(const FrameJob& job, const Group& group,
                                                       const Splats& splats) {
    const GLuint none = 0;
    if (!counts_.reserve(sizeof(Counts)) || !rest_.reserve(4 * (splats.count + 1))) return {};
    glNamedBufferSubData(rest_.name(), 0, 4, &none);
    counts_.bind(0);
    rest_.bind(15);
    project_some(job, group, splats, 4, 1);
    GLuint count = 0;
    glGetNamedBufferSubData(rest_.name(), 0, 4, &count);
    std::vector<GLuint> found(count);
    if (count > 0) glGetNamedBufferSubData(rest_.name(), 4, 4 * static_cast<GLsizeiptr>(count), found.data());
    std::ranges::sort(found);
    return std::vector<std::int64_t>(found.begin(), found.end());
}

namespace {

/// What the processor has projected of some of a layer's splats, in their order.
struct GivenPart {
    Buffer<ScreenSplat> splats;
    std::vector<float> shapes;  // twelve numbers each, of those that are not round
};

/// Splats of one star or Gaussian, in the order of ties.
void order_ties(Buffer<ScreenSplat>& splats) {
    for (std::size_t i = 0, end; i < splats.size(); i = end) {
        for (end = i + 1; end < splats.size() && splats[end].index == splats[i].index;) ++end;
        if (end - i > 1)
            std::sort(splats.begin() + std::ptrdiff_t(i), splats.begin() + std::ptrdiff_t(end),
                      [](const ScreenSplat& a, const ScreenSplat& b) { return in_front_of(a, b); });
    }
}

/// A footprint that is not round, as card_project.glsl reads it.
void add_shape(const FootprintTable& table, const Shape& shape, const ScreenSplat& splat,
               std::vector<float>& to) {
    const ShapedFootprint found = shaped_footprint_at(table, shape, splat.x_px, splat.y_px);
    const Footprint& f = found.round;
    const Ellipse e = ellipse_of(shape);
    const float support_px =
        shape_support_px(shape, {table.reach, 4.0f * table.pixel_filter_px, table.variance});
    to.insert(to.end(),
              {f.lo, f.edge_gain, f.amplitude, f.t, found.xx, found.xy, found.yy, 0.0f, f.scale,
               float(f.node_a - table.nodes.data()), support_px, float(std::sqrt(e.larger * e.smaller))});
}

}  // namespace

/// Projects splats by the processor: `rows` of a layer, or all of them.
bool Card::give(const FrameJob& job, Group& group, std::size_t number,
                const std::vector<std::int64_t>* rows) {
    constexpr std::int64_t chunk = 1024;
    const LayerProjection& layer = job.projections[number];
    const FootprintTable& table = *job.fold_layers[number].footprints;
    const Region& r = group.region;
    const ScreenRect rect{float(r.x), float(r.y), float(r.x + r.width), float(r.y + r.height)};
    const std::int64_t count = rows ? std::ssize(*rows) : job.layers[number].size();
    std::vector<GivenPart> parts(static_cast<std::size_t>(groups_for(count, chunk)));
    parallel_chunks(count, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        job.progress.check();
        auto& [splats, numbers] = parts[begin / chunk];
        if (rows) return project_rows(layer, std::span(*rows).subspan(begin, end - begin), rect, splats);
        Buffer<Shape> shapes;
        astrosplat::project(layer, begin, end, rect, splats, shapes);
        order_ties(splats);
        for (ScreenSplat& splat : splats)
            if (!is_round(splat)) {
                const Shape shape = shapes[shape_number(splat)];
                set_shape_number(splat, static_cast<std::uint32_t>(numbers.size() / 12));
                add_shape(table, shape, splat, numbers);
            }
    });
    const std::int64_t first = std::ssize(given_);
    std::vector<std::pair<std::int64_t, std::int64_t>> begins;  // of a part's splats and shapes
    std::int64_t end = first, shapes = std::ssize(shapes_);
    for (const GivenPart& part : parts) {
        begins.emplace_back(end, shapes);
        end += std::ssize(part.splats);
        shapes += std::ssize(part.shapes);
    }
    given_.resize(static_cast<std::size_t>(end));
    shapes_.resize(static_cast<std::size_t>(shapes));
    parallel_each(std::ssize(parts), 1, [&](std::int64_t i) {
        const auto before = static_cast<std::uint32_t>(begins[i].second / 12);
        for (ScreenSplat& splat : parts[i].splats)
            if (!is_round(splat)) set_shape_number(splat, before + shape_number(splat));
        std::ranges::copy(parts[i].splats, given_.begin() + begins[i].first);
        std::ranges::copy(parts[i].shapes, shapes_.begin() + begins[i].second);
        parts[i] = {};
    });
    const std::int64_t splats = std::ssize(given_) - first, limit = job.settings.memory_limit_bytes;
    if (limit > 0 && std::ssize(given_) * std::int64_t(sizeof(ScreenSplat)) > limit) return false;
    if (splats > 0) group.splats.push_back({number, nullptr, splats, first, 0, 0});
    return true;
}

/// All splats of the group, layer by layer: what the card projects, and what the processor has to.
bool Card::gather(const FrameJob& job, std::size_t number, Group& group) {
    given_.clear();
    shapes_.clear();
    std::int64_t rank = 0;
    for (const std::size_t l : job.groups[number].layers) {
        const RenderLayer& layer = job.layers[l];
        const LayerProjection& projection = job.projections[l];
        const std::size_t first = group.splats.size();
        if (is_given(layer)) {
            if (!give(job, group, l, nullptr)) return false;
        } else if (layer.size() > 0) {
            const bool stars = projection.star_distance > 0.0f;
            const Kept* const kept = keep(layer, stars);
            if (!kept) return false;
            group.splats.push_back({l, kept, layer.size(), 0, 0, 0});
            const auto rest = stars || projection.lod ? rest_of(job, group, group.splats.back())
                                                      : std::vector<std::int64_t>();
            if (!rest || (layer.on_device && !rest->empty())) return false;  // the processor has not its rows
            if (!give(job, group, l, &*rest)) return false;
            group.ranked = group.ranked || !rest->empty();
        }
        for (std::size_t i = first; i < group.splats.size(); ++i)
            group.splats[i].first_rank = static_cast<GLuint>(rank);
        rank += is_given(layer) && group.splats.size() > first ? group.splats[first].count : layer.size();
    }
    for (Splats& splats : group.splats) {
        splats.first_group = group.splat_groups;
        group.count += splats.count;
        group.splat_groups += static_cast<GLuint>(groups_for(splats.count, group_size));
    }
    return send(given_.data(), std::ssize(given_) * std::int64_t(sizeof(ScreenSplat)), given_splats_) &&
           send(shapes_.data(), 4 * std::ssize(shapes_), given_shapes_);
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

/// The buffers that each group fills anew.
std::vector<CardBuffer*> Card::working() {
    std::vector<CardBuffer*> buffers = {&counts_, &arguments_, &begins_,  &entry_begins_, &records_,
                                        &tags_,   &rects_,     &ranks_,   &digits_,       &sums_,
                                        &ranges_, &light_,     &through_, &more_,         &layer_light_};
    for (auto* list : {&keys_, &values_})
        for (CardBuffer& buffer : *list) buffers.push_back(&buffer);
    return buffers;
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

/// What the group's planes begin with, where the fold adds to what is there.
void Card::clear_layers(const FrameJob& job) {
    if (job.settings.aov_layers)
        glClearNamedBufferData(layer_light_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

ProgramSource card_source(const std::string& file, const std::string& defines, bool native_division) {
    ProgramSource source;
    std::istringstream list(defines);
    for (std::string define; std::getline(list, define, ',');) source.defines.push_back(define);
    if (native_division) source.defines.push_back("NATIVE_DIVISION");
    source.compute = {"card_exact.glsl", "card_common.glsl"};
    const auto add = [&](const std::vector<std::string>& names) {
        source.compute.insert(source.compute.end(), names.begin(), names.end());
    };
    if (file == "card_project.glsl")
        add({"maths.glsl", "blend.glsl"}), add(after_projections({"footprint.glsl"}));
    if (file == "card_probe.glsl") add({"maths.glsl"});
    if (file == "card_look.glsl") add({"maths.glsl", "noise.glsl", "look_uniforms.glsl", "look.glsl"});
    if (file == "card_fold.glsl") add({"maths.glsl", "blend.glsl", "lens.glsl", "footprint.glsl"});
    add({file});
    return source;
}

const GlProgram& Card::program(const std::string& file, const std::string& defines) {
    std::unique_ptr<GlProgram>& program = programs_[file + " " + defines];
    if (program) return *program;
    ProgramSource source = card_source(file, defines, native_division_);
    source.edit = edit_;
    try {
        program = std::make_unique<GlProgram>(source);
    } catch (const std::runtime_error& error) {
        throw CardFailed(error.what());
    }
    return *program;
}

void Card::dispatch(const GlProgram& program, std::int64_t groups) {
    program.use();
    const auto count = static_cast<GLuint>(std::max<std::int64_t>(groups, 1)), wide = std::min(count, 32768u);
    glDispatchCompute(wide, (count + wide - 1) / wide, 1);
    barrier();
}

void Card::indirect(const GlProgram& program, int slot) {
    program.use();
    glDispatchComputeIndirect(12 * slot);
    barrier();
}

void Card::plan_pass(const Group& group, int pass) {
    const GlProgram& p = program("card_plan.glsl", fmt::format("PASS {}", pass));
    const Uniforms set{p.name()};
    set("slabs", group.slabs);
    set("splat_groups", group.splat_groups);
    set("only", group.only);
    bind({&begins_, &arguments_});
    dispatch(p, 1);
}

void Card::scan(const CardBuffer& numbers, GLuint fixed_count, int of, int total, int slot) {
    bind({&numbers, &sums_});
    for (int pass = 0; pass < 3; ++pass) {
        const GlProgram& p = program("card_scan.glsl", fmt::format("PASS {}", pass));
        const Uniforms set{p.name()};
        set("fixed_count", fixed_count);
        set("of", of);
        set("total", total);
        if (pass == 1)
            dispatch(p, 1);
        else if (fixed_count > 0)
            dispatch(p, groups_for(fixed_count, scanned));
        else
            indirect(p, slot);
    }
}

/// Back and forth between two pairs of keys and values, eight bits at a time; in which they end up.
int Card::sort(int in, int out, int of, GLuint first_key, GLuint last_key) {
    const int slot = of == 1 ? 0 : 4, bits = std::bit_width(last_key < first_key ? 0 : last_key - first_key);
    for (int shift = 0; shift < bits; shift += 8, std::swap(in, out)) {
        for (int half = 0; half < 2; ++half) {
            const GlProgram& p = program("card_sort.glsl", fmt::format("PASS {}", half));
            const Uniforms set{p.name()};
            set("shift", shift);
            set("base", first_key);
            set("of", of);
            bind({&keys_[in], &values_[in], &keys_[out], &values_[out], &digits_});
            indirect(p, slot);
            if (half == 0) scan(digits_, 0, of, 0, slot + 1);
        }
    }
    return in;
}

void Card::project_some(const FrameJob& job, const Group& group, const Splats& splats, int pass,
                        GLuint every) {
    const LayerProjection& projection = job.projections[splats.layer];
    const FootprintTable& table = *job.fold_layers[splats.layer].footprints;
    const GlProgram& p =
        program("card_project.glsl", fmt::format("PASS {}{}{}{}", pass, group.any ? ",ANY" : "",
                                                 group.ranked ? ",RANKS" : "", splats.kept ? "" : ",GIVEN"));
    const Uniforms set{p.name()};
    set("count", static_cast<GLuint>(splats.count));
    set("first_given", static_cast<GLuint>(splats.first_given));
    set("in_order", int(is_given(job.layers[splats.layer])));
    set("first_group", splats.first_group);
    set("first_rank", splats.first_rank);
    set("all_groups", group.splat_groups);
    set("every", every);
    set("slabs", group.slabs);
    set("only", group.only);
    set_camera(set, projection);
    set_lens(set, projection.lens);
    set("opacity", projection.opacity);
    set("radius_scale", projection.radius_scale);
    set("lod_limit_px", projection.lod ? projection.lod_limit_px : 0.0f);
    set("child_reach", child_reach);
    set("leaves_stars", int(projection.star_distance > 0.0f));
    const Region& r = group.region;
    glProgramUniform4f(p.name(), set.at("region"), float(r.x), float(r.y), float(r.x + r.width),
                       float(r.y + r.height));
    glProgramUniform2i(p.name(), set.at("tiles"), group.columns, group.rows);
    set("reach", table.reach);
    set("margin_px", 4.0f * table.pixel_filter_px);
    set("core", table.core);
    set("integral", table.integral);
    set("linear_in_distance", int(table.linear_in_distance));
    set("flat_core", int(table.flat_core));
    set("layer", static_cast<GLuint>(splats.layer));
    set("table", static_cast<GLuint>(std::ranges::find(group.tables, &table) - group.tables.begin()));
    set("is_hybrid", int(projection.render.blend == Blend::hybrid));
    const glm::vec3& axis = projection.axis_in_camera;
    glProgramUniform3f(p.name(), set.at("axis"), axis.x, axis.y, axis.z);
    set("hybrid_from_deg", projection.render.hybrid_from_deg);
    set("hybrid_to_deg", projection.render.hybrid_to_deg);
    if (splats.kept) {
        const auto& a = splats.kept->arrays;
        bind({&a[0], &a[1], &a[2], &a[3], &begins_, &records_, &keys_[2], &values_[2], &rects_, &moments_,
              &cosines_, &tags_, &ranks_, &a[4]});
    } else {
        bind({&given_splats_, &given_shapes_, &counts_, &counts_, &begins_, &records_, &keys_[2], &values_[2],
              &rects_, &moments_, &cosines_, &tags_, &ranks_});
    }
    dispatch(p, groups_for(groups_for(splats.count, group_size), every));
}

void Card::project(const FrameJob& job, const Group& group, int pass) {
    // A sample of some million splats tells where to cut depth.
    const GLuint every = pass < 2 ? std::max(1u, group.splat_groups / 4096u) : 1u;
    for (const Splats& splats : group.splats) project_some(job, group, splats, pass, every);
}

/// By depth, ties as the processor has them; the pair of keys and values that holds the order.
int Card::put_in_order(const Group& group) {
    const Counts counts = read_counts();
    const auto by_depth = [&](int in) { return sort(in, 1, 1, counts.first_key, counts.last_key); };
    if (!group.ranked) return by_depth(2);  // records are in the order of ties
    const auto pass = [&](int number, const CardBuffer& keys, const CardBuffer& values) {
        const GlProgram& p = program("card_ties.glsl", fmt::format("PASS {}", number));
        Uniforms{p.name()}("vectors", group.any ? 4u : 2u);
        bind({&keys, &values, &ranks_, &keys_[3], &records_});
        indirect(p, 2);
    };
    pass(0, keys_[2], values_[2]);
    glCopyNamedBufferSubData(values_[2].name(), values_[3].name(), 0, 0, values_[3].bytes());
    barrier();
    constexpr GLuint any = 0xffffffffu;
    sort(3, 1, 1, 0, any);  // ends where it began
    pass(1, keys_[2], values_[3]);
    const int order = by_depth(3);
    pass(2, keys_[order], values_[order]);
    return order;
}

/// The pair of keys and values that holds them.
int Card::list_entries(const Group& group, int order) {
    const auto pass = [&](int number) -> const GlProgram& {
        const GlProgram& p = program("card_entries.glsl", fmt::format("PASS {}", number));
        const Uniforms set{p.name()};
        set("tile_columns", group.columns);
        set("tile_count", static_cast<GLuint>(group.columns * group.rows));
        set("slabs", group.listed());
        return p;
    };
    const auto bind_records = [&] {
        bind({&values_[order], &rects_, &entry_begins_, &keys_[0], &values_[0]});
    };
    bind_records();
    indirect(pass(0), 2);
    scan(entry_begins_, 0, 3, 2, 3);
    plan_pass(group, 3);
    bind_records();
    indirect(pass(1), 2);
    mark("sort by tile");
    const int by_tile = sort(0, 1, 2, 0, static_cast<GLuint>(group.columns * group.rows - 1));
    mark("ranges");
    bind({&keys_[by_tile], &ranges_, &values_[by_tile]});
    dispatch(pass(2), groups_for(std::int64_t(group.listed() + 1) * group.columns * group.rows, group_size));
    indirect(pass(3), 6);
    return by_tile;
}

void Card::fold(const FrameJob& job, const Group& group, int by_tile) {
    const GlProgram& p = program(
        "card_fold.glsl", fmt::format("KIND {}{}{}{}{}", int(group.kind), group.any ? ",ANY" : "",
                                      group.screen ? ",SCREEN" : "", group.shaped ? ",SHAPED" : "",
                                      !group.any && group.tables[0]->linear_in_distance ? ",LINEAR" : ""));
    const Uniforms set{p.name()};
    const Region& r = group.region;
    const FootprintTable& table = *group.tables[0];
    const GLuint first = group.only == all_slabs ? 0 : group.only;
    set("slabs", group.listed());
    glProgramUniform2i(p.name(), set.at("corner_px"), int(r.x), int(r.y));
    glProgramUniform2i(p.name(), set.at("size_px"), int(r.width), int(r.height));
    set("tile_columns", group.columns);
    set("stop", job.fold.stop);
    set("alone", int(group.alone));
    set("keeps_layers", int(job.settings.aov_layers));
    set("aovs", int(job.fold.aovs));
    set("reach", table.reach);
    set("margin_px", 4.0f * table.pixel_filter_px);
    bind({&records_, &values_[by_tile], &ranges_, &nodes_, &light_, &through_, &more_, &tags_, &layers_,
          &layer_light_});
    for (GLuint slab = 0; slab < group.listed(); ++slab) {
        set("slab", slab);
        set("begins", int(first + slab == 0));
        set("ends", int(first + slab + 1 == group.slabs));
        p.use();
        glDispatchCompute(static_cast<GLuint>(group.columns), static_cast<GLuint>(group.rows), 1);
        barrier();
    }
}

void Card::mark(const char* pass) {
    if (marked_ == marks_.size()) marks_.emplace_back();
    marks_[marked_].first = pass;
    glQueryCounter(marks_[marked_++].second.get(), GL_TIMESTAMP);
}

std::vector<Card::PassTime> Card::pass_times() const {
    std::vector<PassTime> times;
    GLuint64 before = 0;
    for (std::size_t i = 0; i < marked_; ++i) {
        GLuint64 now = 0;
        glGetQueryObjectui64v(marks_[i].second.name(), GL_QUERY_RESULT, &now);
        if (i > 0) {  // of slab after slab
            const char* const pass = marks_[i - 1].first;
            auto at = std::ranges::find(times, pass, &PassTime::name);
            if (at == times.end()) at = times.insert(at, {pass, 0.0});
            at->milliseconds += 1e-6 * double(now - before);
        }
        before = now;
    }
    return times;
}

Card::Counts Card::read_counts() const {
    Counts counts{};
    glGetNamedBufferSubData(counts_.name(), 0, sizeof counts, &counts);
    return counts;
}

/// How many splats show, slab by slab.
void Card::count(const FrameJob& job, const Group& group) {
    counts_.bind(0);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments_.name());
    plan_pass(group, 0);
    if (group.slabs > 1) {
        project(job, group, 0);
        project(job, group, 1);
        plan_pass(group, 1);
    }
    project(job, group, 2);
    scan(begins_, group.slabs * group.splat_groups, 0, 1, 0);
    plan_pass(group, 2);
}

/// Records and entries of all slabs or of one, after they were counted; the pair that holds the entries.
int Card::list_slabs(const FrameJob& job, const Group& group) {
    const auto room = static_cast<GLuint>(keys_[0].bytes() / 4);
    const GLuint none[2] = {};
    glNamedBufferSubData(counts_.name(), offsetof(Counts, entries_room), 4, &room);
    glNamedBufferSubData(counts_.name(), offsetof(Counts, entries_low), sizeof none, none);
    plan_pass(group, 3);
    mark("project");
    project(job, group, 3);
    mark("sort by depth");
    const int order = put_in_order(group);
    mark("entries");
    return list_entries(group, order);
}

/// Whether no tile lists so many splats that Mesa's software rasterisers lose some: they end the loops of a
/// thread after 65,535 rounds in all, without a word. More slabs are what helps.
bool Card::is_shallow(const Group& group) const {
    if (!info_.software) return true;
    constexpr GLuint most = 32768;
    const std::size_t slabs = group.listed() + 1;
    std::vector<GLuint> range(slabs * std::size_t(group.columns) * std::size_t(group.rows));
    glGetNamedBufferSubData(ranges_.name(), 0, GLsizeiptr(4 * range.size()), range.data());
    for (std::size_t i = 0; i + 1 < range.size(); ++i)
        if ((i + 1) % slabs != 0 && range[i + 1] - range[i] > most) return false;
    return true;
}

/// All slabs at once. The last group's splats may have been few and wide: entries are counted, and listed
/// again where there was no room for all.
bool Card::fold_together(const FrameJob& job, const Group& group) {
    auto entries = std::int64_t(double(group.count) * std::min(entries_each_, most_each));
    for (;;) {
        job.progress.check();
        if (!reserve(job, group, group.count, entries)) return false;
        clear_layers(job);
        marked_ = 0;
        mark("count");
        count(job, group);
        const int by_tile = list_slabs(job, group);
        if (!is_shallow(group)) return false;
        mark("fold");
        fold(job, group, by_tile);
        mark("");
        const Counts counts = read_counts();
        if (counts.entries_high > 0) return false;
        entries = std::int64_t(spare * counts.entries_wanted);
        entries_each_ = std::max(2.5, double(entries) / double(std::max<std::int64_t>(group.count, 1)));
        if (counts.entries_wanted <= counts.entries) return true;
    }
}

/// One slab after the other, in memory for the fullest. What they have drawn stays.
bool Card::fold_apart(const FrameJob& job, Group& group) {
    if (!reserve(job, group, 1, 1)) return false;
    clear_layers(job);
    marked_ = 0;
    mark("count");
    count(job, group);
    const Counts all = read_counts();
    const auto size_of = [&](GLuint slab) { return all.slab_begin[slab + 1] - all.slab_begin[slab]; };
    GLuint fullest = 1;
    for (GLuint slab = 0; slab < group.slabs; ++slab) fullest = std::max(fullest, size_of(slab));
    auto entries = std::int64_t(double(fullest) * std::min(entries_each_, most_each));
    for (group.only = 0; group.only < group.slabs;) {
        job.progress.check();
        if (!reserve(job, group, fullest, entries)) return false;
        const int by_tile = list_slabs(job, group);
        const Counts counts = read_counts();
        if (counts.entries_high > 0) return false;
        entries = std::max(entries, std::int64_t(spare * counts.entries_wanted));
        if (counts.entries_wanted > counts.entries) continue;
        if (!is_shallow(group)) return false;
        mark("fold");
        fold(job, group, by_tile);
        ++group.only;
    }
    mark("");
    glNamedBufferSubData(counts_.name(), 0, sizeof all, &all);  // of all slabs
    return true;
}

/// The group's region into its rows of the planes.
bool Card::read_planes(const FrameJob& job, const Group& group, GroupPlanes& planes) {
    const auto rows = [&](const CardBuffer& from, std::int64_t first_pixel, Image& to) {
        return read(from, first_pixel, group, job, to);
    };
    bool is_whole = rows(light_, 0, planes.light);
    if (!group.alone) is_whole = is_whole && rows(through_, 0, planes.through);
    if (!group.alone && group.any) is_whole = is_whole && rows(more_, 0, planes.more);
    for (std::size_t l = 0; l < planes.layer_light.size(); ++l)
        is_whole = is_whole && rows(layer_light_, std::int64_t(l) * group.pixels, planes.layer_light[l]);
    return is_whole;
}

bool Card::read(const CardBuffer& from, std::int64_t first_pixel, const Group& group, const FrameJob& job,
                Image& to) {
    const std::int64_t bytes = 16 * group.pixels;
    if (!staging_.reserve(bytes, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT)) return false;
    glCopyNamedBufferSubData(from.name(), staging_.name(), 16 * first_pixel, 0, bytes);
    const auto* data =
        static_cast<const float*>(glMapNamedBufferRange(staging_.name(), 0, bytes, GL_MAP_READ_BIT));
    if (!data) return false;
    constexpr std::int64_t chunk = 1 << 18;
    float* const rows = to.at(0, group.region.y - job.region.y);
    parallel_chunks(bytes / 4, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::copy(data + begin, data + end, rows + begin);
    });
    return glUnmapNamedBuffer(staging_.name());
}

bool Card::draw_band(const FrameJob& job, Group& group, const Share& share, GroupPlanes& planes) {
    group.slabs = slabs_for(group.count, share);
    group.only = all_slabs;
    if (!(share.apart ? fold_apart(job, group) : fold_together(job, group))) return false;
    if (share.bands == 1) note_counts(planes);
    return read_planes(job, group, planes) && glGetError() == GL_NO_ERROR;
}

void Card::note_counts(GroupPlanes& planes) const {
    const Counts counts = read_counts();
    planes.splats = counts.visible;
    planes.footprint_px = (4294967296.0 * counts.area_high + counts.area_low) / 16.0;
}

/// The frame in bands, each a region of its own. `whole`: all of it, of which no more than counts fits.
bool Card::draw_bands(const FrameJob& job, std::size_t number, Group& whole, const Share& share,
                      GroupPlanes& planes) {
    whole.slabs = 1;
    whole.only = all_slabs;
    const std::int64_t begins = whole.splat_groups + 1;
    if (!counts_.reserve(sizeof(Counts)) || !arguments_.reserve(3 * 4 * 8) || !begins_.reserve(4 * begins) ||
        !sums_.reserve(4 * (begins / scanned + 64)))
        return false;
    count(job, whole);
    note_counts(planes);
    const Region& all = job.region;
    const std::int64_t rows = groups_for(all.height, share.bands);
    for (std::int64_t y = 0; y < all.height; y += rows) {
        const Region band{all.x, all.y + y, all.width, std::min(rows, all.height - y)};
        Group group = plan(job, number, whole.alone, band);
        if (!gather(job, number, group) || !draw_band(job, group, share, planes)) return false;
    }
    return true;
}

/// Room for what is read back.
GroupPlanes Card::new_planes(const FrameJob& job, const Group& group) {
    GroupPlanes planes;
    const auto plane = [&] { return unfilled_image(job.region.width, job.region.height, 4); };
    planes.light = plane();
    if (!group.alone) planes.through = plane();
    if (!group.alone && group.any) planes.more = plane();
    if (job.settings.aov_layers)
        for (std::size_t l = 0; l < job.layers.size(); ++l) planes.layer_light.push_back(plane());
    return planes;
}

std::optional<GroupPlanes> Card::draw(const FrameJob& job, std::size_t number, bool alone) try {
    ++frames_;
    Group group = plan(job, number, alone, job.region);
    if (!upload_tables(job, group) || !gather(job, number, group)) return {};
    GroupPlanes planes = new_planes(job, group);
    const bool as_before = group.count >= short_of_.splats && group.pixels >= short_of_.pixels;
    for (std::size_t at = as_before ? short_of_.share : 0; at < std::size(shares); ++at) {
        share_ = shares[at];
        const bool drawn = share_.bands == 1 ? draw_band(job, group, share_, planes)
                                             : draw_bands(job, number, group, share_, planes);
        if (drawn && at > 0) short_of_ = {group.count, group.pixels, at};
        if (drawn) return planes;
        for (CardBuffer* const buffer : working()) buffer->release();
    }
    lost_ = glGetGraphicsResetStatus() != GL_NO_ERROR;
    return {};
} catch (const CardFailed& failed) {
    log_warning(failed.what());
    return {};
}

/// The arrays that this look reads, uploaded where they are not there yet. False: there is no memory for
/// them.
bool Card::keep_set(const SplatSet& set, const LookUniforms& look, bool with_uv, KeptSet& kept) {
    const std::int64_t n = set.size();
    const auto put = [&](std::size_t array, const auto& values) {
        CardBuffer& buffer = kept.arrays[array];
        if (buffer.bytes() > 0) return true;
        const auto bytes = n * std::int64_t(sizeof values[0]);
        return bytes <= most_bytes_ && make_room(bytes) && send(values.data(), bytes, buffer);
    };
    return put(0, set.position) && put(1, set.color) && put(2, set.alpha) && put(3, set.distance) &&
           put(4, set.id) && (!look.radius.own || put(5, set.radius)) && (!with_uv || put(6, set.uv));
}

std::optional<DeviceLook> Card::shade(const SplatSet& set, std::uint64_t set_stamp, const LookUniforms& look,
                                      const Image* map, std::uint64_t stamp) try {
    if (lost_ || set.size() == 0) return {};
    const bool with_map = look.stop_count > 1;
    KeptSet& raw = sets_[set_stamp];
    raw.frame = frames_ + 1;  // which is about to be drawn
    // Looks follow one another: the last one's arrays are the next one's.
    const auto last =
        std::ranges::find_if(kept_, [&](const auto& k) { return k.second.set_stamp == set_stamp; });
    Kept made;
    if (last != kept_.end()) made = std::move(kept_.extract(last).mapped());
    auto& [positions, radii, alphas, colors, stars] = made.arrays;
    made.set_stamp = set_stamp;
    made.frame = frames_ + 1;
    const std::int64_t n = set.size();
    const GLuint none[4] = {};
    GLuint totals[3] = {};
    const Image no_map = make_image(1, 1, 3);
    const Image& texels = with_map ? *map : no_map;
    const bool fits =
        keep_set(set, look, with_map, raw) &&
        make_room(32 * n - positions.bytes() - radii.bytes() - alphas.bytes() - colors.bytes()) &&
        positions.reserve(12 * n) && radii.reserve(4 * n) && alphas.reserve(4 * n) &&
        colors.reserve(12 * n) && (stars.bytes() > 0 || fill_stars(set.id, stars)) &&
        look_uniforms_.fill(&look, sizeof look) &&
        look_map_.fill(texels.pixels.data(), 4 * std::ssize(texels.pixels)) &&
        look_totals_.fill(none, sizeof none);
    if (!fits) {
        sets_.erase(set_stamp);
        return {};
    }
    const GlProgram& p = program("card_look.glsl", "");
    const Uniforms to{p.name()};
    to("splats", static_cast<GLuint>(n));
    glProgramUniform3i(p.name(), to.at("map_size"), int(texels.width), int(texels.height),
                       int(texels.channels));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, look_uniforms_.name());
    const auto& a = raw.arrays;
    bind({&a[0], &a[1], &a[2], &a[3], &a[4], look.radius.own ? &a[5] : &a[3], with_map ? &a[6] : &a[3],
          &look_map_, &positions, &radii, &alphas, &colors, &look_totals_});
    dispatch(p, groups_for(n, group_size));
    glGetNamedBufferSubData(look_totals_.name(), 0, sizeof totals, totals);
    if (glGetError() != GL_NO_ERROR) return {};
    kept_[{stamp, nullptr}] = std::move(made);
    return DeviceLook{totals[0], std::bit_cast<float>(totals[1]), std::bit_cast<float>(totals[2])};
} catch (const CardFailed& failed) {
    log_warning(failed.what());
    return {};
}

std::int64_t Card::bytes() {
    std::int64_t sum = 0;
    for (const CardBuffer* const buffer : working()) sum += buffer->bytes();
    for (const CardBuffer* buffer :
         {&layers_, &nodes_, &moments_, &cosines_, &rest_, &given_splats_, &given_shapes_})
        sum += buffer->bytes();
    for (const auto& [key, kept] : kept_)
        for (const CardBuffer& array : kept.arrays) sum += array.bytes();
    for (const auto& [key, kept] : sets_)
        for (const CardBuffer& array : kept.arrays) sum += array.bytes();
    return sum;
}

}  // namespace astrosplat
