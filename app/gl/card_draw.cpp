// Groups of a frame, all slabs at once, one after the other, or band by band.
#include <fmt/format.h>

#include "core/log.h"
#include "core/parallel.h"
#include "gl/card_parts.h"

namespace astrosplat {

using namespace card;

namespace {

constexpr int tile_px = 16;
constexpr std::int64_t most_px = 32768;  // of a side: 256 splats over all tiles still have countable entries
constexpr std::size_t most_falloffs = 100;  // whose nodes have numbers of 16 bits
// Slabs from so many splats on, of so many each: 256 MB of records of 32 bytes.
constexpr std::int64_t slabs_from = 12'000'000, splats_of_slab = 8'000'000;
constexpr double spare = 1.05, most_each = 16.0;  // entries of a splat: the last group's may have been wide
// What is tried, one after the other, until the memory suffices.
constexpr Card::Share shares[] = {{}, {true, 8}, {true, 32}, {false, 0, 4}, {true, 32, 4}, {true, 32, 16}};

bool is_screen(const FoldLayer& layer) {
    return layer.blend == Blend::screen && !layer.holdout && !layer.absorbs;
}

}  // namespace

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

/// What the group's planes begin with, where the fold adds to what is there.
void Card::clear_layers(const FrameJob& job) {
    if (job.settings.aov_layers)
        glClearNamedBufferData(layer_light_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
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
} catch (const Failed& failed) {
    log_warning(failed.what());
    return {};
}

}  // namespace astrosplat
