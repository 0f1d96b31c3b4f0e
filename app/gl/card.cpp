#include "gl/card.h"

#include <fmt/format.h>

#include <sstream>

#include "core/parallel.h"
#include "splats/splat_set.h"

namespace astrosplat {

namespace {

constexpr GLuint most_slabs = 32, group_size = 256, sorted = 4096, scanned = 2048;
constexpr int tile_px = 16;
// Slabs from so many splats on, of so many each: 256 MB of records of 32 bytes.
constexpr std::int64_t slabs_from = 12'000'000, splats_of_slab = 8'000'000;
constexpr std::uint64_t frames_kept = 64;  // splats that so many draws did not ask for give their memory back
constexpr int segments = FootprintNode::segments;

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

bool is_screen(const FoldLayer& layer) {
    return layer.blend == Blend::screen && !layer.holdout && !layer.absorbs;
}

}  // namespace

bool CardBuffer::reserve(std::int64_t bytes, GLbitfield flags) {
    if (bytes <= bytes_) return true;
    buffer_.reset();
    bytes_ = 0;
    while (glGetError() != GL_NO_ERROR) {
    }
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

Card::Card(const GlInfo& info, bool native_division) : info_(info), native_division_(native_division) {
    if (info.major * 10 + info.minor < 45)
        throw NoContext(fmt::format("{} has OpenGL {}.{}, and 4.5 is needed to draw exactly", info.renderer,
                                    info.major, info.minor));
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    most_bytes_ = std::min<std::int64_t>(bytes, 0x7fffffff);
}

std::string Card::cannot(const FrameJob& job) const {
    if (shared::is_onto_sphere(job.fold.lens)) return "projections onto the sphere";
    std::int64_t splats = 0;
    for (std::size_t l = 0; l < job.layers.size(); ++l) {
        const RenderLayer& layer = job.layers[l];
        if (layer.blocks) return "layers that are read block by block";
        if (layer.stars) return "stars";
        if (!layer.splats->stretch.empty()) return "splats that are not round";
        if (job.projections[l].lod) return "level of detail";
        if (job.projections[l].star_distance > 0.0f) return "stars that stay points";
        splats = std::max(splats, layer.size());
    }
    // Records of 64 bytes are what takes most a splat.
    if (64 * splats > most_bytes_) return "so many splats";
    if (job.region.width > 65536 || job.region.height > 65536) return "so large a frame";
    return {};
}

Card::Group Card::plan(const FrameJob& job, std::size_t number, bool alone) {
    const BlendGroup& blend = job.groups[number];
    Group group{{}, {}, blend.kind, alone, false, false, 0, job.region.width * job.region.height, 0, 1, 0, 0};
    bool flat = false, screen = blend.kind == FoldKind::general;
    for (const std::size_t l : blend.layers) {
        const FoldLayer& layer = job.fold_layers[l];
        if (std::ranges::find(group.tables, layer.footprints) == group.tables.end())
            group.tables.push_back(layer.footprints);
        flat = flat || layer.footprints->flat_core;
        screen = screen && is_screen(layer);
        const std::int64_t splats = job.layers[l].size();
        group.layers.push_back({l, nullptr, group.splat_groups});
        group.splats += splats;
        group.splat_groups += static_cast<GLuint>(groups_for(splats, group_size));
    }
    group.any =
        flat || job.fold.aovs || group.tables.size() > 1 || (blend.kind == FoldKind::general && !screen);
    group.screen = screen && !group.any;
    const std::int64_t slabs = slabs_ > 0                  ? slabs_
                               : group.splats < slabs_from ? 1
                                                           : groups_for(group.splats, splats_of_slab);
    group.slabs = static_cast<GLuint>(std::min<std::int64_t>(slabs, most_slabs));
    group.columns = static_cast<int>(groups_for(job.region.width, tile_px));
    group.rows = static_cast<int>(groups_for(job.region.height, tile_px));
    return group;
}

std::array<CardBuffer, 4>* Card::keep(const ShadedSplats& splats) {
    std::erase_if(kept_, [&](const auto& kept) { return kept.second.frame + frames_kept < frames_; });
    // Without a stamp nobody knows whether they are the same.
    const std::pair key{splats.stamp, splats.stamp != 0 ? nullptr : &splats};
    Kept& kept = kept_[key];
    const bool there = splats.stamp != 0 && kept.frame != 0;
    kept.frame = frames_;
    if (there) return &kept.arrays;
    const std::int64_t n = splats.size();
    const bool fits = kept.arrays[0].fill(splats.position.data(), 12 * n) &&
                      kept.arrays[1].fill(splats.radius.data(), 4 * n) &&
                      kept.arrays[2].fill(splats.alpha.data(), 4 * n) &&
                      kept.arrays[3].fill(splats.color.data(), 12 * n);
    if (fits) return &kept.arrays;
    kept_.erase(key);
    return nullptr;
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

bool Card::reserve(const FrameJob& job, const Group& group) {
    const std::int64_t n = std::max<std::int64_t>(group.splats, 1),
                       tiles = std::int64_t(group.columns) * group.rows;
    const std::int64_t entries = std::max(n, std::int64_t(double(n) * entries_each_)) + sorted;
    const std::int64_t record_bytes = group.any ? 64 : 32;
    if (record_bytes * n > most_bytes_ || 4 * entries > most_bytes_) return false;
    for (int i = 0; i < 3; ++i)
        if (!keys_[i].reserve(4 * (i < 2 ? entries : n)) || !values_[i].reserve(4 * (i < 2 ? entries : n)))
            return false;
    const std::int64_t begins = group.splat_groups * std::int64_t(group.slabs) + 1;
    const std::int64_t digits = 256 * (groups_for(keys_[0].bytes() / 4, sorted) + 1);
    const auto all = [](std::initializer_list<std::pair<CardBuffer*, std::int64_t>> wanted) {
        return std::ranges::all_of(wanted, [](const auto& want) { return want.first->reserve(want.second); });
    };
    if (!all({{&counts_, (8 + 1024 + 33) * 4},
              {&arguments_, 3 * 4 * 8},
              {&begins_, 4 * std::max(begins, groups_for(n, group_size) + 1)},
              {&records_, record_bytes * n},
              {&tags_, group.any ? 8 * n : 16},
              {&rects_, 8 * n},
              {&digits_, 4 * digits},
              {&sums_, 4 * (std::max(digits, begins) / scanned + 64)},
              {&ranges_, 4 * tiles * (group.slabs + 1)},
              {&light_, 16 * group.pixels},
              {&through_, 16 * group.pixels},
              {&more_, group.any ? 16 * group.pixels : 16}}))
        return false;
    if (!job.settings.aov_layers) return layer_light_.reserve(16);
    const std::int64_t bytes = 16 * group.pixels * std::ssize(job.layers);
    if (bytes > most_bytes_ || !layer_light_.reserve(bytes)) return false;
    glClearNamedBufferData(layer_light_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
    return true;
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
    if (file == "card_fold.glsl") add({"maths.glsl", "blend.glsl", "lens.glsl", "footprint.glsl"});
    add({file});
    return source;
}

const GlProgram& Card::program(const std::string& file, const std::string& defines) {
    std::unique_ptr<GlProgram>& program = programs_[file + " " + defines];
    if (!program) program = std::make_unique<GlProgram>(card_source(file, defines, native_division_));
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

/// Back and forth between two pairs of keys and values, `passes` times eight bits; an even number of them.
void Card::sort(int in, int out, int of, int passes) {
    const int slot = of == 1 ? 0 : 4;
    for (int pass = 0; pass < passes; ++pass, std::swap(in, out)) {
        for (int half = 0; half < 2; ++half) {
            const GlProgram& p = program("card_sort.glsl", fmt::format("PASS {}", half));
            const Uniforms set{p.name()};
            set("shift", 8 * pass);
            set("of", of);
            bind({&keys_[in], &values_[in], &keys_[out], &values_[out], &digits_});
            indirect(p, slot);
            if (half == 0) scan(digits_, 0, of, 0, slot + 1);
        }
    }
}

void Card::project_layer(const FrameJob& job, const Group& group, const Layer& layer, int pass,
                         GLuint every) {
    const LayerProjection& projection = job.projections[layer.number];
    const FootprintTable& table = *job.fold_layers[layer.number].footprints;
    const GlProgram& p =
        program("card_project.glsl", fmt::format("PASS {}{}", pass, group.any ? ",ANY" : ""));
    const Uniforms set{p.name()};
    const std::int64_t count = job.layers[layer.number].size();
    set("count", static_cast<GLuint>(count));
    set("first_group", layer.first_group);
    set("all_groups", group.splat_groups);
    set("every", every);
    set("slabs", group.slabs);
    set_camera(set, projection);
    set_lens(set, projection.lens);
    set("opacity", projection.opacity);
    set("radius_scale", projection.radius_scale);
    const Region& r = job.region;
    glProgramUniform4f(p.name(), set.at("region"), float(r.x), float(r.y), float(r.x + r.width),
                       float(r.y + r.height));
    glProgramUniform2i(p.name(), set.at("tiles"), group.columns, group.rows);
    set("reach", table.reach);
    set("margin_px", 4.0f * table.pixel_filter_px);
    set("core", table.core);
    set("integral", table.integral);
    set("linear_in_distance", int(table.linear_in_distance));
    set("flat_core", int(table.flat_core));
    set("layer", static_cast<GLuint>(layer.number));
    set("table", static_cast<GLuint>(std::ranges::find(group.tables, &table) - group.tables.begin()));
    set("is_hybrid", int(projection.render.blend == Blend::hybrid));
    glProgramUniform3f(p.name(), set.at("axis"), projection.axis_in_camera.x, projection.axis_in_camera.y,
                       projection.axis_in_camera.z);
    set("hybrid_from_deg", projection.render.hybrid_from_deg);
    set("hybrid_to_deg", projection.render.hybrid_to_deg);
    const auto& splats = *layer.splats;
    bind({&splats[0], &splats[1], &splats[2], &splats[3], &begins_, &records_, &keys_[2], &values_[2],
          &rects_, &moments_, &cosines_, &tags_});
    dispatch(p, groups_for(groups_for(count, group_size), every));
}

void Card::project(const FrameJob& job, const Group& group, int pass) {
    // A sample of some million splats tells where to cut depth.
    const GLuint every = pass < 2 ? std::max(1u, group.splat_groups / 4096u) : 1u;
    for (const Layer& layer : group.layers)
        if (job.layers[layer.number].size() > 0) project_layer(job, group, layer, pass, every);
}

void Card::list_entries(const Group& group) {
    const auto pass = [&](int number) -> const GlProgram& {
        const GlProgram& p = program("card_entries.glsl", fmt::format("PASS {}", number));
        const Uniforms set{p.name()};
        set("tile_columns", group.columns);
        set("tile_count", static_cast<GLuint>(group.columns * group.rows));
        set("slabs", group.slabs);
        return p;
    };
    const auto bind_records = [&] { bind({&values_[2], &rects_, &begins_, &keys_[0], &values_[0]}); };
    bind_records();
    indirect(pass(0), 2);
    scan(begins_, 0, 3, 2, 3);
    plan_pass(group, 3);
    bind_records();
    indirect(pass(1), 2);
    const int bits = std::bit_width(static_cast<unsigned>(group.columns * group.rows - 1));
    sort(0, 1, 2, bits > 16 ? 4 : 2);
    bind({&keys_[0], &ranges_, &values_[0]});
    dispatch(pass(2), groups_for(std::int64_t(group.slabs + 1) * group.columns * group.rows, group_size));
    indirect(pass(3), 6);
}

void Card::fold(const FrameJob& job, const Group& group) {
    const GlProgram& p = program(
        "card_fold.glsl",
        fmt::format("KIND {}{}{}", int(group.kind), group.any ? ",ANY" : "", group.screen ? ",SCREEN" : ""));
    const Uniforms set{p.name()};
    const Region& r = job.region;
    const FootprintTable& table = *group.tables[0];
    set("slabs", group.slabs);
    glProgramUniform2i(p.name(), set.at("corner_px"), int(r.x), int(r.y));
    glProgramUniform2i(p.name(), set.at("size_px"), int(r.width), int(r.height));
    set("tile_columns", group.columns);
    set("stop", job.fold.stop);
    set("alone", int(group.alone));
    set("keeps_layers", int(job.settings.aov_layers));
    set("aovs", int(job.fold.aovs));
    set("reach", table.reach);
    set("margin_px", 4.0f * table.pixel_filter_px);
    set("linear_in_distance", int(table.linear_in_distance));
    bind({&records_, &values_[0], &ranges_, &nodes_, &light_, &through_, &more_, &tags_, &layers_,
          &layer_light_});
    for (GLuint slab = 0; slab < group.slabs; ++slab) {
        set("slab", slab);
        p.use();
        glDispatchCompute(static_cast<GLuint>(group.columns), static_cast<GLuint>(group.rows), 1);
        barrier();
    }
}

Card::Counts Card::run(const FrameJob& job, const Group& group) {
    counts_.bind(0);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments_.name());
    plan_pass(group, 0);
    const auto room = static_cast<GLuint>(keys_[0].bytes() / 4);
    glNamedBufferSubData(counts_.name(), offsetof(Counts, entries_room), 4, &room);
    if (group.slabs > 1) {
        project(job, group, 0);
        project(job, group, 1);
        plan_pass(group, 1);
    }
    project(job, group, 2);
    scan(begins_, group.slabs * group.splat_groups, 0, 1, 0);
    plan_pass(group, 2);
    plan_pass(group, 3);
    project(job, group, 3);
    sort(2, 1, 1, 4);
    list_entries(group);
    fold(job, group);
    Counts counts{};
    glGetNamedBufferSubData(counts_.name(), 0, sizeof counts, &counts);
    return counts;
}

bool Card::read(const CardBuffer& from, std::int64_t first_pixel, Image& to) {
    const std::int64_t bytes = 16 * to.width * to.height;
    if (!staging_.reserve(bytes, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT)) return false;
    glCopyNamedBufferSubData(from.name(), staging_.name(), 16 * first_pixel, 0, bytes);
    const auto* data =
        static_cast<const float*>(glMapNamedBufferRange(staging_.name(), 0, bytes, GL_MAP_READ_BIT));
    if (!data) return false;
    constexpr std::int64_t chunk = 1 << 18;
    parallel_chunks(bytes / 4, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::copy(data + begin, data + end, to.pixels.data() + begin);
    });
    return glUnmapNamedBuffer(staging_.name());
}

std::optional<GroupPlanes> Card::draw(const FrameJob& job, std::size_t number, bool alone) {
    ++frames_;
    Group group = plan(job, number, alone);
    for (Layer& layer : group.layers) {
        job.progress.check();
        layer.splats = keep(*job.layers[layer.number].splats);
        if (!layer.splats) return {};
    }
    if (!upload_tables(job, group)) return {};
    Counts counts{};
    do {
        job.progress.check();
        if (!reserve(job, group)) return {};
        counts = run(job, group);
        constexpr double spare = 1.05;
        if (counts.visible > 0)
            entries_each_ = std::max(entries_each_, spare * counts.entries_wanted / double(group.splats));
    } while (counts.entries_wanted > counts.entries);
    GroupPlanes planes;
    planes.splats = counts.visible;
    planes.footprint_px = (4294967296.0 * counts.area_high + counts.area_low) / 16.0;
    const auto read_image = [&](const CardBuffer& from, std::int64_t first_pixel, Image& to) {
        to = make_image(job.region.width, job.region.height, 4);
        return read(from, first_pixel, to);
    };
    bool is_whole = read_image(light_, 0, planes.light);
    if (!alone) {
        is_whole = is_whole && read_image(through_, 0, planes.through);
        if (group.any) is_whole = is_whole && read_image(more_, 0, planes.more);
    }
    if (job.settings.aov_layers)
        for (std::size_t l = 0; l < job.layers.size(); ++l)
            is_whole = is_whole && read_image(layer_light_, std::int64_t(l) * group.pixels,
                                              planes.layer_light.emplace_back());
    if (!is_whole || glGetError() != GL_NO_ERROR) return {};
    return planes;
}

std::int64_t Card::bytes() const {
    std::int64_t sum = 0;
    for (const CardBuffer* buffer :
         {&counts_, &arguments_, &begins_, &records_, &tags_, &rects_, &sums_, &digits_, &ranges_, &light_,
          &through_, &more_, &layer_light_, &layers_, &nodes_, &moments_, &cosines_, &staging_})
        sum += buffer->bytes();
    for (int i = 0; i < 3; ++i) sum += keys_[i].bytes() + values_[i].bytes();
    for (const auto& [key, kept] : kept_)
        for (const CardBuffer& array : kept.arrays) sum += array.bytes();
    return sum;
}

}  // namespace astrosplat
