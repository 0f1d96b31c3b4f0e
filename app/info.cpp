// info: what any file the program reads holds. parameters: every key of a scene file with default, range and
// meaning, from the one description in the engine; of one scene also what they are there.
#include <fmt/format.h>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <variant>

#include "camera_files/camera_track.h"
#include "command.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "exit.h"
#include "objects/identify.h"
#include "output/metadata.h"
#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/frames.h"
#include "sets/load_source.h"
#include "source/fits.h"
#include "source/mesh.h"
#include "source/origin.h"
#include "source/picture.h"
#include "source/texture.h"
#include "splat_files/splat_file.h"
#include "stars/catalogue.h"

namespace astrosplat {
namespace {

Report to_report(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Report to_report(const Bounds& box) {
    if (box.empty()) return "empty";
    return {{"lo", to_report(box.lo)}, {"hi", to_report(box.hi)}};
}

/// The smallest and the largest value.
template <class Values>
Report extremes(const Values& values) {
    if (values.empty()) return "none";
    const auto [least, most] = std::ranges::minmax(values);
    return {number(least), number(most)};
}

Report describe_splats(const fs::path& file) {
    const SplatSet set = read_splats(file);
    warn_of_no_splats(set, file.string());
    const std::vector<std::string> attributes = splat_attributes(file);
    Report report = {{"kind", "splats"},
                     {"splats", set.size()},
                     {"bounds", to_report(bounds(set))},
                     {"attributes", attributes}};
    for (const std::string& name : attributes) {
        if (name == "alpha") report[name] = extremes(set.alpha);
        if (name == "distance") report[name] = extremes(set.distance);
        if (name == "radius") report[name] = extremes(set.radius);
    }
    report["max_distance"] = set.max_distance;
    report["spacing"] = to_report(set.spacing);
    if (!set.credit.empty()) report["credit"] = set.credit;
    if (!set.origin.empty()) report["origin"] = set.origin;
    return report;
}

Report describe_mesh(const fs::path& file) {
    const Mesh mesh = load_obj(file);
    std::int64_t with_uv = 0;
    for (const Mesh::Triangle& triangle : mesh.triangles) with_uv += triangle.uv[0] != Mesh::no_uv;
    Report maps = Report::array();
    for (const fs::path& map : mesh.maps) maps.push_back(map.string());
    return {{"kind", "mesh"},
            {"vertices", mesh.positions.size()},
            {"triangles", mesh.triangles.size()},
            {"triangles_with_uv", with_uv},
            {"texture_coordinates", mesh.uvs.size()},
            {"area", surface_area(mesh)},
            {"bounds", to_report(bounds(mesh))},
            {"maps", maps}};
}

/// Warns where it shows nothing. What cannot be read as a picture has headers all the same.
void look_at_picture(const fs::path& file) try {
    load_texture({file}, {}, TextureSettings::Wrap::clamp, {}, {make_prepared, {}, texels_read_whole});
} catch (const InputError& error) {
    log_warning(error.what());
}

/// Groups of names and values in words; nothing where there are no tags.
void add_tags(Report& report, const std::vector<AvmTag>& tags) {
    for (const auto& [group, name, values] : tags) {
        std::vector<std::string> words;
        for (const std::string& value : values) {
            const std::string meaning = name == "category" ? words_of_category(value) : "";
            words.push_back(meaning.empty() ? value : fmt::format("{} ({})", value, meaning));
        }
        report["avm"][group][name] = words.size() == 1 ? Report(words[0]) : Report(words);
    }
}

Report describe_hdu(const FitsHdu& hdu) {
    Report report = {{"number", hdu.number}, {"kind", hdu.kind}};
    if (!hdu.name.empty()) report["name"] = hdu.name;
    if (hdu.axes.empty()) return report;
    report["size"] = hdu.axes;
    if (hdu.bitpix == 0) return report;
    report["bitpix"] = hdu.bitpix;
    report["min"] = number(hdu.range.min);
    report["max"] = number(hdu.range.max);
    report["percentile_0.25"] = number(hdu.range.black);
    report["percentile_99.75"] = number(hdu.range.white);
    report["nan_count"] = hdu.nan_count;
    return report;
}

/// Of the picture that is taken; empty: its header tells nothing.
Report describe_sky(const fs::path& file) try {
    const FitsSky sky = open_fits_rows(file, "auto", {}, {}).plane.sky;
    if (!sky.grid)
        return sky.unfollowed.empty() ? Report() : Report(sky.unfollowed + ", which is not followed");
    const glm::dvec2 reference = sky.grid->reference_deg();
    return {{"reference_deg", {reference.x, reference.y}}, {"degrees_per_px", sky.grid->degrees_per_px()}};
} catch (const InputError&) {
    return {};
}

/// What its cards say, as AVM would, of whose version it is not. A file without a picture says nothing.
std::vector<AvmTag> tags_of_fits(const fs::path& file) try {
    std::vector<AvmTag> tags = find_avm_tags(xmp_packet(read_picture_metadata(file)));
    std::erase_if(tags, [](const AvmTag& tag) { return tag.group == "publisher"; });
    return tags;
} catch (const InputError&) {
    return {};
}

Report describe_fits_file(const fs::path& file) {
    look_at_picture(file);
    const QuietLog quiet;  // what is taken was said when it was looked at
    Report report = {{"kind", format_of_file(file)->id}}, hdus = Report::array();
    for (const FitsHdu& hdu : describe_fits(file)) hdus.push_back(describe_hdu(hdu));
    report["hdus"] = hdus;
    if (const Report sky = describe_sky(file); !sky.is_null()) report["sky"] = sky;
    add_tags(report, tags_of_fits(file));
    return report;
}

bool is_packed(const std::string& name) { return name == "astrosplat/hashed"; }

/// Unreadable values are counted.
std::string key_count(std::string_view packed) {
    const std::string text = unpack_hashed_text(std::string(packed)).value_or("");
    return counted(std::count(text.begin(), text.end(), '\n'), "key");
}

Report describe_image(const fs::path& file) {
    const ImageInfo info = read_image_info(file);
    Report channels = Report::array(), metadata = Report::object();
    for (const auto& [name, type] : info.channels) channels.push_back(name + " " + type);
    for (const auto& [name, value] : info.metadata)
        if (name != "xmp")
            metadata[name] = is_packed(name) ? key_count(trim(value)) : trim(value);  // long texts are padded
    Report report = {{"kind", "image"},
                     {"format", info.file_format},
                     {"width", info.width},
                     {"height", info.height},
                     {"channels", channels}};
    if (info.width != info.whole_width || info.height != info.whole_height) {
        report["whole_frame"] = {info.whole_width, info.whole_height};
        report["at"] = {info.x, info.y};
    }
    if (!info.parts.empty()) report["pictures"] = info.parts;
    const FrameHeader header = read_frame_header(file);
    if (header.frame_hash.empty()) {
        look_at_picture(file);
    } else {
        report["frame_hash"] = header.frame_hash;
        report["pixel_hash"] = header.pixel_hash;
        report["whole"] = frame_is_whole(file);
    }
    add_tags(report, read_avm_tags(file));
    report["metadata"] = metadata;
    return report;
}

Report describe_catalogue(const fs::path& file) {
    const StarCatalogue catalogue = read_catalogue(file);
    std::vector<double> magnitudes;
    std::int64_t distances = 0, colors = 0;
    for (const CatalogueStar& star : catalogue.stars) {
        magnitudes.push_back(star.magnitude);
        distances += star.distance_pc > 0.0 ? 1 : 0;
        colors += star.color_index ? 1 : 0;
    }
    Report report = {{"kind", "stars"},
                     {"of", "the sky"},
                     {"stars", catalogue.stars.size()},
                     {"with_distance", distances},
                     {"with_color_index", colors},
                     {"magnitudes", extremes(magnitudes)}};
    if (catalogue.bad.count > 0) report["bad_rows"] = catalogue.bad.text(catalogue.rows);
    return report;
}

Report describe_picture_table(const fs::path& file) {
    const PictureTable table = read_picture_table(file);
    std::vector<double> light{0.0};
    if (!table.stars.empty()) light.clear();
    for (const TableStar& star : table.stars) light.push_back(star.luminance());
    Report report = {{"kind", "stars"},
                     {"of", "a picture"},
                     {"stars", table.stars.size()},
                     {"luminances", extremes(light)},
                     {"median_sigma_px", number(median_sigma_px(table))}};
    if (table.bad.count > 0) report["bad_rows"] = table.bad.text(table.rows);
    return report;
}

Report describe_layer(const LayerParams& layer) {
    constexpr std::array kinds = {"mesh", "splats", "stars"};
    Report report = {{"name", layer.name},
                     {"visible", layer.visible},
                     {"kind", kinds[static_cast<std::size_t>(layer.source.kind)]}};
    if (layer.source.kind == SourceKind::splats) report["file"] = layer.source.file.string();
    if (layer.source.kind == SourceKind::stars) report["catalogue"] = layer.source.stars.catalogue.string();
    if (!layer.source.stars.like.empty()) report["like"] = layer.source.stars.like;
    Report meshes = Report::array();
    for (const MeshInput& input : layer.source.meshes) {
        Report textures = Report::array();
        for (const fs::path& texture : input.texture) textures.push_back(texture.string());
        meshes.push_back({{"mesh", input.mesh.string()}, {"texture", textures}});
    }
    if (!meshes.empty()) report["meshes"] = meshes;
    if (const std::string origin = origin_of(layer.source); !origin.empty()) report["origin"] = origin;
    return report;
}

Report describe_scene(const fs::path& file) {
    const auto [scene, places] = load_placed(file);
    check_renderable(scene, places);
    const std::vector<std::int64_t> frames =
        parse_frames(scene.output.frames, file.string() + ": output.frames");
    Report layers = Report::array(), animated = Report::array();
    for (const LayerParams& layer : scene.layers) layers.push_back(describe_layer(layer));
    for (const Track& track : scene.animation) animated.push_back(track.key.text());
    Report report = {{"kind", "scene"},
                     {"resolution", {scene.output.width, scene.output.height}},
                     {"frames", scene.output.frames},
                     {"frame_count", frames.size()},
                     {"fps", scene.output.fps},
                     {"output", scene.output.path},
                     {"layers", layers},
                     {"animated", animated}};
    if (scene.light_years_per_unit > 0.0) report["light_years_per_unit"] = number(scene.light_years_per_unit);
    return report;
}

/// Of another program's camera.
Report describe_camera(const fs::path& file) {
    const CameraTrack track = read_camera(file, {});
    for (const std::string& warning : track.warnings) log_warning(warning);
    Bounds places;
    std::vector<double> lenses;
    for (const TrackSample& sample : track.samples) {
        places.add(sample.eye);
        lenses.push_back(track.orthographic() ? sample.height : sample.fov_deg);
    }
    Report report = {{"kind", "camera"},
                     {"projection", name_of(track.projection)},
                     {"samples", track.samples.size()},
                     {"frames", {track.samples.front().frame, track.samples.back().frame}},
                     {"places", to_report(places)},
                     {"up", track.up == FileUp::z ? "z" : "y"}};
    if (track.has_fov || track.orthographic())
        report[track.orthographic() ? "height" : "fov_deg"] = extremes(lenses);
    report["shifted"] = track.has_shift;
    if (track.fps > 0.0) report["fps"] = track.fps;
    return report;
}

bool is_keyframe_table(const fs::path& file) {
    const FileFormat* const format = format_by_name(file);
    return format && format->id == "table" && TextTable(read_file(file)).column({"frame"}) != TextTable::none;
}

Report describe_keyframes(const fs::path& file) {
    Scene scene = parse_unchecked("astrosplat = 1\n", file);
    const std::vector<Track> tracks = read_csv_tracks(file, {}, scene);
    Report keys = Report::array();
    for (const Track& track : tracks) keys.push_back(track.key.text());
    const auto& rows = tracks.front().keyframes;
    return {{"kind", "keyframes"},
            {"samples", rows.size()},
            {"frames", {rows.front().frame, rows.back().frame}},
            {"keys", keys}};
}

/// Files of formats that hold both are splats where they hold any.
Report describe_splats_or_camera(const fs::path& file) try {
    return describe_splats(file);
} catch (const InputError&) {
    if (!is_camera_file(file)) throw;
    try {
        return describe_camera(file);
    } catch (const InputError&) {
    }
    throw;
}

Report describe(const fs::path& file) {
    switch (kind_of(format_of_file(file))) {
        case FileKind::splats:
            return describe_splats_or_camera(file);
        case FileKind::scene:
            return describe_scene(file);
        case FileKind::mesh:
            return describe_mesh(file);
        default:
            if (const CatalogueKind kind = kind_of_catalogue(file); kind != CatalogueKind::none)
                return kind == CatalogueKind::sky ? describe_catalogue(file) : describe_picture_table(file);
            if (is_camera_file(file)) return describe_camera(file);
            if (is_keyframe_table(file)) return describe_keyframes(file);
            if (format_of_file(file) && format_of_file(file)->id == "table") return describe_catalogue(file);
            if (const std::string_view advice = conversion_advice(file); !advice.empty())
                bad_input(file, "a format that is read", file.extension().string() + std::string(advice));
            return is_fits(file) ? describe_fits_file(file) : describe_image(file);
    }
}

int run_info(const CommandOptions& options) {
    const fs::path& file = options.input;
    require_readable(file);
    Report report = {{"file", file.string()}};
    report.update(describe(file));
    print_report(report, options.json);
    return exit_done;
}

}  // namespace

void add_info(CLI::App& app, Invocation& call) {
    CLI::App& command = add_command(app, call, "info", "Describes any file the program reads", run_info);
    add_input(command, call.options, "FILE", "Scene, mesh, picture, frame, splat, star or camera file");
    add_json(command, call.options);
}

namespace {

Report to_report(const Value& value) {
    if (const Value::List* list = value.list()) {
        Report items = Report::array();
        for (const Value& item : *list) items.push_back(to_report(item));
        return items;
    }
    if (const std::string* text = value.text()) return *text;
    if (const bool* flag = std::get_if<bool>(&value.data)) return *flag;
    if (const std::int64_t* whole = std::get_if<std::int64_t>(&value.data)) return *whole;
    return value.number();
}

Report to_report(const ParameterSpec& spec, const char* value_name, const Value& value) {
    Report report = {{"key", spec.key.text()}, {"type", name_of(spec.type)}, {value_name, to_report(value)},
                     {"unit", spec.unit},      {"label", spec.label},        {"help", spec.help}};
    if (is_numeric(spec.type)) {
        report["min"] = spec.min;
        report["max"] = spec.max;
    }
    if (!spec.zero.empty()) report["zero"] = std::string(spec.zero);
    if (!spec.choices.empty()) report["choices"] = spec.choices;
    report["animated"] = name_of(spec.animation);
    return report;
}

/// Keys as --set takes them, with their values; also of a scene on its way to becoming one.
std::vector<ParameterRow> rows_of(const fs::path& name) {
    const fs::path file = find_by_name("scenes", name);
    Scene scene = parse_unchecked(read_file(file), file);
    std::vector<ParameterRow> rows;
    for (const Parameter& parameter : describe(scene).parameters)
        rows.push_back({parameter.spec, parameter.get()});
    return rows;
}

std::string value_table(const std::vector<ParameterRow>& rows) {
    std::string table;
    for (const ParameterRow& row : rows)
        table += fmt::format("{:<44} = {}\n", row.spec.key, to_toml(row.value));
    return table;
}

struct ParametersOptions {
    bool names = false;
};

/// `options.input`: a scene's file or short name; empty: keys as the manual has them.
int run_parameters(const CommandOptions& options, const ParametersOptions& own) {
    const bool of_scene = !options.input.empty();
    const std::vector<ParameterRow> rows = of_scene ? rows_of(options.input) : parameter_rows();
    if (options.json) {
        Report report = Report::array();
        for (const ParameterRow& row : rows)
            report.push_back(to_report(row.spec, of_scene ? "value" : "default", row.value));
        print_report(report, true);
    } else if (own.names) {
        for (const ParameterRow& row : rows) fmt::print("{}\n", row.spec.key);
    } else {
        fmt::print("{}", of_scene ? value_table(rows) : parameter_table());
    }
    return exit_done;
}

}  // namespace

void add_parameters(CLI::App& app, Invocation& call) {
    auto [command, own] =
        add_command(app, call, "parameters", "Lists every key of a scene file", run_parameters);
    add_value(command, "SCENE", call.options.input, "SCENE",
              "Lists the keys of this scene as --set takes them, with their values");
    command.add_flag("--names", own.names, "Prints only the keys");
    add_json(command, call.options);
}

}  // namespace astrosplat
