// Titles, kinds and folders of the file dialogs.
#include "gui/file_dialog.h"

#include <algorithm>
#include <string_view>

#include "core/file_format.h"
#include "scene/camera_file.h"
#include "scene/describe.h"

namespace astrosplat {
namespace fs = std::filesystem;
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
        {Kind::new_from_file, "New scene from a picture, mesh or splat file", "pictures", sources},
        {Kind::open, "Open a scene", "scenes", scenes},
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

}  // namespace astrosplat
