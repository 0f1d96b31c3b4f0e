// The card's programs and what they are told. Which pass does what: shaders/card_*.glsl.
#include <fmt/format.h>

#include <sstream>

#include "gl/card_parts.h"

namespace astrosplat {

using namespace card;

namespace {

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

/// What card_layer.glsl asks for.
void set_layer(const Uniforms& set, const LayerProjection& layer, const FootprintTable& table,
               const Region& r) {
    set_camera(set, layer);
    set_lens(set, layer.lens);
    set("opacity", layer.opacity);
    set("radius_scale", layer.radius_scale);
    set("lod_limit_px", layer.lod ? layer.lod_limit_px : 0.0f);
    set("child_reach", child_reach);
    set("leaves_stars", int(layer.star_distance > 0.0f));
    glProgramUniform4f(set.program, set.at("region"), float(r.x), float(r.y), float(r.x + r.width),
                       float(r.y + r.height));
    set("reach", table.reach);
    set("margin_px", 4.0f * table.pixel_filter_px);
    set("is_hybrid", int(layer.render.blend == Blend::hybrid));
    const glm::vec3& axis = layer.axis_in_camera;
    glProgramUniform3f(set.program, set.at("axis"), axis.x, axis.y, axis.z);
    set("hybrid_from_deg", layer.render.hybrid_from_deg);
    set("hybrid_to_deg", layer.render.hybrid_to_deg);
}

}  // namespace

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
        add({"maths.glsl", "blend.glsl"}), add(after_projections({"footprint.glsl", "card_layer.glsl"}));
    if (file == "card_children.glsl") {
        add({"maths.glsl", "noise.glsl", "blend.glsl", "child_types.glsl", "children.glsl"});
        add(after_projections({"card_layer.glsl", "card_tables.glsl", "circle.glsl", "child_tables.glsl"}));
    }
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
        throw Failed(error.what());
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

void Card::set_children(const GlProgram& p, const FrameJob& job, const Group& group, std::size_t number) {
    const LayerProjection& layer = job.projections[number];
    const LayerRender& render = layer.render;
    const Uniforms set{p.name()};
    set_layer(set, layer, *job.fold_layers[number].footprints, group.region);
    set("count", static_cast<GLuint>(job.layers[number].size()));
    set("layer", static_cast<GLuint>(number));
    set("seed", GLuint{layer.seed});
    set("finest", finest_level(render.lod.max_children));
    set("blend", int(render.holdout ? Blend::over : render.blend));
    set("own_blend", int(render.blend));
    set("keeps_opaque", int(render.falloff.shape == Falloff::Shape::constant));
    set("noise", render.lod.noise);
    set("star_distance", layer.star_distance);
    glProgramUniform1dv(p.name(), set.at("circle_numbers"), 14, real::circle_numbers.data());
}

void Card::project_some(const FrameJob& job, const Group& group, const Splats& splats, int pass,
                        GLuint every) {
    const LayerProjection& projection = job.projections[splats.layer];
    const FootprintTable& table = *job.fold_layers[splats.layer].footprints;
    const GlProgram& p =
        program("card_project.glsl", fmt::format("PASS {}{}{}{}", pass, group.any ? ",ANY" : "",
                                                 group.ranked ? ",RANKS" : "", splats.kept ? "" : ",GIVEN"));
    const Uniforms set{p.name()};
    set_layer(set, projection, table, group.region);
    set("count", static_cast<GLuint>(splats.count));
    set("first_given", static_cast<GLuint>(splats.first_given));
    set("in_order", int(is_given(job.layers[splats.layer])));
    set("first_group", splats.first_group);
    set("first_rank", splats.first_rank);
    set("all_groups", group.splat_groups);
    set("every", every);
    set("slabs", group.slabs);
    set("only", group.only);
    glProgramUniform2i(p.name(), set.at("tiles"), group.columns, group.rows);
    set("core", table.core);
    set("integral", table.integral);
    set("linear_in_distance", int(table.linear_in_distance));
    set("flat_core", int(table.flat_core));
    set("layer", static_cast<GLuint>(splats.layer));
    set("table", static_cast<GLuint>(std::ranges::find(group.tables, &table) - group.tables.begin()));
    if (splats.kept) {
        const auto& a = splats.kept->arrays;
        bind({&a[0], &a[1], &a[2], &a[3], &begins_, &records_, &keys_[2], &values_[2], &rects_, &moments_,
              &cosines_, &tags_, &ranks_, splats.kept->ids ? splats.kept->ids : &a[0]});
    } else {
        bind({splats.given, &given_shapes_, &counts_, &counts_, &begins_, &records_, &keys_[2], &values_[2],
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

}  // namespace astrosplat
