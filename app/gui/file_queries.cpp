// Titles, kinds and folders of the file dialogs.
#include "gui/file_queries.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "core/file_format.h"
#include "scene/camera_file.h"
#include "scene/describe.h"
#include "scene/export_camera.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

using Extensions = std::vector<std::string>;
const Extensions pictures = endings_of({FileKind::picture});
const Extensions sources = endings_of({FileKind::picture, FileKind::mesh, FileKind::splats});
const Extensions scenes = endings_of({FileKind::scene});
const Extensions frames = endings_of({FileKind::picture}, FileUse::written);

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

FileQuery reading(const char* title, const char* kind, const Extensions& extensions,
                  const Document& document) {
    return {title, false, kind, extensions, folder_of_document(document), ""};
}
FileQuery writing(const char* title, const char* kind, const Extensions& extensions, const Document& document,
                  const std::string& name) {
    return {title, true, kind, extensions, folder_of_document(document), name};
}

/// The kind of a file of the scene.
struct FileWish {
    std::string_view key;  // generic
    const char* kind;
    Extensions (*extensions)();
};

template <FileKind kind>
Extensions all_of() {
    return endings_of({kind});
}

constexpr FileWish wishes[] = {{"layer.source.meshes.texture", "pictures", all_of<FileKind::picture>},
                               {"layer.source.meshes.depth_map", "pictures", all_of<FileKind::picture>},
                               {"layer.source.meshes.mesh", "meshes", all_of<FileKind::mesh>},
                               {"layer.source.prepare.align", "pictures", all_of<FileKind::picture>},
                               {"layer.source.prepare.fill", "pictures", all_of<FileKind::picture>},
                               {"layer.source.prepare.mask", "pictures", all_of<FileKind::picture>},
                               {"layer.source.mask.image", "pictures", all_of<FileKind::picture>},
                               {"layer.source.mask.any.image", "pictures", all_of<FileKind::picture>},
                               {"layer.source.file", "splats", all_of<FileKind::splats>},
                               {"layer.look.thickness.map", "pictures", all_of<FileKind::picture>},
                               {"layer.preset", "looks", all_of<FileKind::scene>},
                               {"environment.image", "pictures", all_of<FileKind::picture>},
                               {"environment.cube", "pictures", all_of<FileKind::picture>},
                               {"environment.tile", "pictures", all_of<FileKind::picture>},
                               {"reference.file", "pictures", all_of<FileKind::picture>},
                               {"output.preset", "presets", all_of<FileKind::scene>},
                               {"camera.file", "cameras", [] { return endings_of(FileUse::camera_read); }}};

/// That of the file which is there now; empty where none is.
fs::path folder_of_value(const Value& value, const fs::path& scene_folder) {
    const bool listed = value.list() && !value.list()->empty();
    const std::string* const text = listed ? value.list()->front().text() : value.text();
    if (!text || text->empty()) return {};
    return (scene_folder / *text).parent_path().lexically_normal();
}

}  // namespace

std::optional<FileQuery> query_for(Command::Kind kind, const Document& document) {
    using Kind = Command::Kind;
    switch (kind) {
        case Kind::new_from_file:
            return reading("New scene from a picture, mesh or splat file", "pictures", sources, document);
        case Kind::open:
            return reading("Open a scene", "scenes", scenes, document);
        case Kind::import_file:
            return reading("Import as a layer", "pictures, meshes or splats", sources, document);
        case Kind::choose_picture:
            return reading("Picture on the mesh", "pictures", pictures, document);
        case Kind::set_reference:
            return reading("Picture to compare with", "pictures", pictures, document);
        case Kind::import_camera:
            return reading("Import the camera of another program", "cameras",
                           endings_of(FileUse::camera_read), document);
        case Kind::export_camera:
            return writing("Write the camera for other programs", "cameras",
                           endings_of(FileUse::camera_written), document, stem(document) + ".usda");
        case Kind::apply_look:
            return reading("Apply a look to the selected layer", "looks", scenes, document);
        case Kind::save_as:
            return writing("Save the scene as", "scenes", scenes, document, stem(document) + ".toml");
        case Kind::save_look:
            return writing("Export the selected layer's look", "looks", scenes, document, "look.toml");
        case Kind::choose_target:
            return writing("Where the files go", "pictures and movies", {}, document,
                           stem(document) + ".####.exr");
        case Kind::prepare_picture:
            return writing("Write the prepared picture and its stars to a new folder", "files", {}, document,
                           stem(document) + "-prepared");
        case Kind::save_view:
            return writing("Save the frame as it is seen", "pictures", {".png"}, document,
                           stem(document) + ".png");
        case Kind::screenshot:
            return writing("Save what the window shows", "pictures", {".png", ".exr"}, document,
                           stem(document) + ".png");
        default:
            return std::nullopt;
    }
}

FileQuery query_for(const ParameterKey& key, const Document& document) {
    Scene scene = document.scene();
    const Description description = describe(scene);
    const Parameter* const parameter = find_parameter(description, key);
    const std::string label = parameter ? parameter->spec.label : key.text(), layer = key.layer();
    FileQuery query{layer.empty() ? label : label + " of " + layer, false, "files", {}, {}, ""};
    const ParameterKey generic = key.generic();
    const auto wish = std::ranges::find_if(
        wishes, [&](const FileWish& w) { return w.key == generic.text() || generic.is_below(w.key); });
    if (wish != std::end(wishes)) {
        query.kind = wish->kind;
        query.extensions = wish->extensions();
    }
    query.folder = parameter ? folder_of_value(parameter->get(), scene.file.parent_path()) : fs::path();
    query.otherwise = folder_of_document(document);
    if (query.folder.empty()) query.folder = query.otherwise;
    return query;
}

}  // namespace astrosplat
