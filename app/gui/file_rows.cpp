// Titles, kinds and folders of the file dialogs; their rows and the columns above them.
#include <fmt/format.h>

#include "core/file_format.h"
#include "gui/file_dialog.h"
#include "gui/widgets.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using Extensions = std::vector<std::string>;

/// The file of a command.
struct CommandFile {
    Command::Kind command;
    const char *title, *kind;
    Extensions extensions;    // empty: any
    const char* name = "";    // suggested, when saving; "": it is read
    bool after_scene = true;  // the scene's name comes before it
};

const std::vector<CommandFile>& command_files() {
    using Kind = Command::Kind;
    static const Extensions pictures = endings_of({FileKind::picture}),
                            scenes = endings_of({FileKind::scene}),
                            sources = endings_of({FileKind::picture, FileKind::mesh, FileKind::splats});
    static const std::vector<CommandFile> files{
        {Kind::open, "Open a scene, or a picture, mesh or splat file as a new one", "scenes or pictures",
         endings_of({FileKind::scene, FileKind::picture, FileKind::mesh, FileKind::splats})},
        {Kind::import_file, "Import as a layer", "pictures, meshes or splats", sources},
        {Kind::choose_picture, "Picture on the mesh", "pictures", pictures},
        {Kind::set_reference, "Picture to compare with", "pictures", pictures},
        {Kind::import_camera, "Import the camera of another program", "cameras",
         endings_of(FileUse::camera_read)},
        {Kind::apply_look, "Apply a look to the selected layer", "looks", scenes},
        {Kind::export_camera, "Write the camera for other programs", "cameras",
         endings_of(FileUse::camera_written), ".usda"},
        {Kind::save_as, "Save the scene as", "scenes", scenes, ".toml"},
        {Kind::save_look, "Export the selected layer's look", "looks", scenes, "look.toml", false},
        {Kind::choose_target, "Where the files go", "pictures and movies", {}, ".####.exr"},
        {Kind::prepare_picture,
         "Write the prepared picture and its stars to a new folder",
         "files",
         {},
         "-prepared"},
        {Kind::save_view, "Save the frame as it is seen", "pictures", {".png"}, ".png"},
        {Kind::screenshot, "Save what the window shows", "pictures", {".png", ".exr"}, ".png"}};
    return files;
}

/// The kind of a file of the scene.
struct ParameterFile {
    std::string_view key;  // generic
    const char* kind;
    Extensions extensions;
};

const std::vector<ParameterFile>& parameter_files() {
    static const Extensions pictures = endings_of({FileKind::picture}),
                            scenes = endings_of({FileKind::scene});
    static const std::vector<ParameterFile> files{
        {"layer.source.meshes.texture", "pictures", pictures},
        {"layer.source.meshes.depth_map", "pictures", pictures},
        {"layer.source.meshes.mesh", "meshes", endings_of({FileKind::mesh})},
        {"layer.source.prepare.align", "pictures", pictures},
        {"layer.source.prepare.starless", "pictures", pictures},
        {"layer.source.prepare.fill", "pictures", pictures},
        {"layer.source.prepare.mask", "pictures", pictures},
        {"layer.source.mask.image", "pictures", pictures},
        {"layer.source.mask.any.image", "pictures", pictures},
        {"layer.source.file", "splats", endings_of({FileKind::splats})},
        {"layer.look.thickness.map", "pictures", pictures},
        {"layer.preset", "looks", scenes},
        {"environment.image", "pictures", pictures},
        {"environment.cube", "pictures", pictures},
        {"environment.tile", "pictures", pictures},
        {"reference.file", "pictures", pictures},
        {"output.preset", "presets", scenes},
        {"camera.file", "cameras", endings_of(FileUse::camera_read)}};
    return files;
}

fs::path folder_of_document(const Document& document) {
    if (!document.file().empty()) return document.file().parent_path();
    std::error_code ignored;
    return fs::current_path(ignored);
}

/// The name of its files: an untitled scene is called as what it was made of.
std::string stem(const Document& document) {
    const fs::path& file = document.file().empty() ? document.scene().file : document.file();
    return file.stem().string();
}

/// That of the file which is there now; empty where none is.
fs::path folder_of_value(const Value& value, const fs::path& scene_folder) {
    const bool listed = value.list() && !value.list()->empty();
    const std::string* const text = listed ? value.list()->front().text() : value.text();
    if (!text || text->empty()) return {};
    return (scene_folder / *text).parent_path().lexically_normal();
}

}  // namespace

std::optional<FileQuery> query_for(Command::Kind kind, const Document& document) {
    const auto file = std::ranges::find(command_files(), kind, &CommandFile::command);
    if (file == command_files().end()) return std::nullopt;
    const std::string name = file->name;
    return FileQuery{file->title,
                     !name.empty(),
                     file->kind,
                     file->extensions,
                     folder_of_document(document),
                     (name.empty() || !file->after_scene ? "" : stem(document)) + name};
}

FileQuery query_for(const ParameterKey& key, const Document& document) {
    Scene scene = document.scene();
    const Description description = describe(scene);
    const Parameter* const parameter = find_parameter(description, key);
    const std::string label = parameter ? parameter->spec.label : key.text(), layer = key.layer();
    FileQuery query{layer.empty() ? label : label + " of " + layer, false, "files", {}, {}, ""};
    const ParameterKey generic = key.generic();
    const auto file = std::ranges::find_if(parameter_files(), [&](const ParameterFile& f) {
        return f.key == generic.text() || generic.is_below(f.key);
    });
    if (file != parameter_files().end()) {
        query.kind = file->kind;
        query.extensions = file->extensions;
    }
    query.folder = parameter ? folder_of_value(parameter->get(), scene.file.parent_path()) : fs::path();
    query.otherwise = folder_of_document(document);
    if (query.folder.empty()) query.folder = query.otherwise;
    return query;
}

namespace {

constexpr float time_width = 128, size_width = 76;
constexpr float row_thumbnail_width = 72, row_thumbnail_height = 48;

struct FileColumn {
    const char* label;
    FileOrder order;
    float x, width;  // px
    bool at_right;
};

// Its name, and an arrow where the rows are in its order. True when clicked.
bool draw_column(GuiFrame& frame, const FileColumn& column, const ImVec2& corner, bool chosen,
                 bool backwards) {
    const float row = px(file_row_height), middle = corner.y + row * 0.5f;
    ImGui::SetCursorScreenPos({corner.x + column.x, corner.y});
    const bool clicked = ImGui::InvisibleButton(column.label, {column.width, row});
    note_item(frame, std::string("file/by ") + column.label);
    const ImU32 text_color = chosen || ImGui::IsItemHovered() ? color::text : color::dim;
    const float text_width = ImGui::CalcTextSize(column.label).x;
    const float text_x = corner.x + column.x + (column.at_right ? column.width - px(8) - text_width : 0.0f);
    ImDrawList* list = ImGui::GetWindowDrawList();
    draw_text({text_x, middle - std::floor(ImGui::GetFontSize() * 0.5f)}, text_color, column.label);
    const float arrow_x = column.at_right ? text_x - px(12) : text_x + text_width + px(12);
    const Icon arrow = backwards ? Icon::chevron_up : Icon::chevron_down;
    if (chosen) draw_icon(list, arrow, {arrow_x, middle}, px(9), color::dim);
    return clicked;
}

// As large as its frame allows; the sign of a file where it cannot be read.
void draw_thumbnail(ImVec2 corner, const ListedThumbnail* thumbnail) {
    const Rect area(corner, {px(row_thumbnail_width), px(row_thumbnail_height)});
    if (!thumbnail || !thumbnail->texture) {
        image_box(area, {}, 0.0f, 2);
        if (thumbnail) draw_icon(ImGui::GetWindowDrawList(), Icon::file, area.middle(), px(13), color::dim);
        return;
    }
    const float aspect = static_cast<float>(thumbnail->width) / static_cast<float>(thumbnail->height);
    image_box(area, thumbnail->texture, aspect, 2);
}

std::string note_of(const FileRow& row) {
    if (!row.thumbnail || !row.thumbnail->texture) return {};
    return fmt::format("{} x {} px", row.thumbnail->width, row.thumbnail->height);
}

}  // namespace

FileClick file_row(const char* id, const FileRow& row) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = px(row.high ? thumbnail_row_height : file_row_height);
    const float room = ImGui::GetContentRegionAvail().x;
    FileClick click;
    click.once = ImGui::InvisibleButton(id, {room, height});
    click.twice =
        entered_by_key() || (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 back = row.chosen ? color::selection : ImGui::IsItemHovered() ? color::hover : color::none;
    fill_rect(corner, {corner.x + room, corner.y + height}, back, px(3));
    const float middle = corner.y + height * 0.5f;
    if (row.picture)
        draw_thumbnail({corner.x + px(6), middle - px(0.5f * row_thumbnail_height)}, row.thumbnail);
    else
        draw_icon(list, row.icon, {corner.x + px(row.high ? 6 + 0.5f * row_thumbnail_width : 14), middle},
                  px(13), color::dim);
    const float text_x = corner.x + px(row.high ? row_thumbnail_width + 16 : 28);
    const float beside = row.time.empty() ? 0.0f : px(time_width + size_width);
    const float text_room = corner.x + room - px(8) - beside - text_x;
    const float line = std::floor(ImGui::GetFontSize()), y = std::floor(middle - line * 0.5f);
    const std::string note = note_of(row);
    const float name_y = note.empty() ? y : y - std::floor(line * 0.6f);
    draw_text({text_x, name_y}, color::text, fitting(row.text, text_room));
    draw_text({text_x, name_y + std::floor(line * 1.2f)}, color::dim, note);
    draw_text({corner.x + room - beside, y}, color::dim, row.time);
    const float size_x = corner.x + room - px(8) - ImGui::CalcTextSize(row.size.c_str()).x;
    draw_text({size_x, y}, color::dim, row.size);
    return click;
}

bool draw_file_columns(GuiFrame& frame, float room, FileOrder& order, bool& backwards) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float time_x = room - px(time_width + size_width);
    const FileColumn columns[] = {{"Name", FileOrder::name, px(28), time_x - px(28), false},
                                  {"Changed", FileOrder::changed, time_x, px(time_width), false},
                                  {"Size", FileOrder::size, room - px(size_width), px(size_width), true}};
    bool clicked = false;
    for (const FileColumn& column : columns) {
        if (!draw_column(frame, column, corner, order == column.order, backwards)) continue;
        backwards = order == column.order && !backwards;
        order = column.order;
        clicked = true;
    }
    ImGui::SetCursorScreenPos({corner.x, corner.y + px(file_row_height)});
    return clicked;
}

}  // namespace astrosplat
