// A scene: sources + looks + layers + camera + environment + animation + output, as plain values.
// load.h reads it from TOML, save.h writes it back, describe.h lists every parameter, animate.h evaluates
// frame k.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/camera.h"
#include "camera/keyframe.h"
#include "core/text.h"
#include "look/look.h"
#include "ocio/display_transform.h"
#include "render/environment.h"
#include "render/frame.h"
#include "scene/parameter_key.h"
#include "source/source.h"

namespace astrosplat {

struct OutputParams {
    enum class Depth { automatic, half_float, float32, uint16, uint8 };
    friend constexpr auto names_of(Depth) {
        return names_up_to<Depth::uint8>("auto", "half", "float", "16", "8");
    }
    enum class Compression { automatic, zip, zips, piz, dwaa, deflate, lzw, none };
    friend constexpr auto names_of(Compression) {
        return names_up_to<Compression::none>("auto", "zip", "zips", "piz", "dwaa", "deflate", "lzw", "none");
    }
    enum class Alpha { automatic, premultiplied, straight, none };
    friend constexpr auto names_of(Alpha) {
        return names_up_to<Alpha::none>("auto", "premultiplied", "straight", "none");
    }
    enum class View { automatic, linear, srgb, soft };
    friend constexpr auto names_of(View) { return names_up_to<View::soft>("auto", "linear", "srgb", "soft"); }
    enum class Primaries { rec709, acescg };
    friend constexpr auto names_of(Primaries) { return names_up_to<Primaries::acescg>("rec709", "acescg"); }
    fs::path preset;                           // of [output] and [camera], for a kind of screen; empty: none
    std::int64_t width = 1920, height = 1080;  // resolution, px
    std::string frames = "1-240";
    double fps = 24.0;
    std::string path = "frames/shot.####.exr";  // pattern, relative to the scene's folder
    Depth depth = Depth::automatic;
    Compression compression = Compression::automatic;
    Alpha alpha = Alpha::automatic;
    Primaries primaries = Primaries::rec709;  // of scene light in exr
    static constexpr std::array<const char*, 4> known_aovs{"depth", "coverage", "count", "layers"};
    std::vector<std::string> aovs;  // of known_aovs
    View view = View::automatic;
    OcioParams ocio;            // in place of `view` where it is wanted
    double exposure = 0.0;      // stops
    double pixel_filter = 0.5;  // px
    std::int64_t samples = 32;  // renderings of a frame with motion blur or depth of field
    bool holds(std::string_view aov) const { return std::ranges::find(aovs, aov) != aovs.end(); }
    bool operator==(const OutputParams&) const = default;
};

struct ProvenanceParams {
    std::string title, credit, type = "auto";  // "auto": as the sources are
    bool operator==(const ProvenanceParams&) const = default;
};

/// A picture that the window compares the view with. Reaches no rendered file.
struct ReferenceParams {
    enum class View { any, camera, free, front, top, side };
    friend constexpr auto names_of(View) {
        return names_up_to<View::side>("any", "camera", "free", "front", "top", "side");
    }
    fs::path file;
    View view = View::any;     // in which it is compared
    std::string frames;        // at which, as OutputParams has them; empty: all
    glm::dvec2 position{0.0};  // of its middle from the frame's, frame heights to the right and up
    double scale = 1.0;        // its height in frame heights
    double rotate = 0.0;       // degrees, counter-clockwise
    bool mirrored = false;     // left to right, before it is turned
    double opacity = 1.0;      // over the view
    bool operator==(const ReferenceParams&) const = default;
};

struct LayerTransform {
    glm::dvec3 translate{0.0};
    glm::dvec3 rotate{0.0};  // degrees about x, then y, then z
    double scale = 1.0;
    bool operator==(const LayerTransform&) const = default;
};

struct LayerParams {
    std::string name;
    bool visible = true;
    glm::dvec3 axis{0.0, 1.0, 0.0};
    fs::path preset;
    LayerTransform transform;
    SourceParams source;
    Look look;
    LayerRender render;
    bool operator==(const LayerParams&) const = default;
};

/// One animated parameter, as in the file. Values are kept as numbers per component: scalars 1, colours and
/// vectors 3, rotations 4; booleans 0 or 1; choices by their index.
struct Track {
    ParameterKey key;  // "camera.position", "layer.stars.render.core"
    std::vector<Keyframe<std::vector<double>>> keyframes;
    Interpolation interpolation = Interpolation::linear;  // the default of keyframes that do not say
    Ends ends = Ends::ease;
    bool constant_speed = false;
    bool operator==(const Track&) const = default;
};

/// The content of camera.file as tracks that win over those of [animation], and the settings it was read for.
struct ImportedCamera {
    struct Source {
        fs::path file;
        double scale = 1.0, offset = 0.0, file_fps = 0.0, aspect = 1.0;
        CameraFileUp up = CameraFileUp::automatic;
        double output_fps = 24.0;
        Projection projection = Projection::perspective;
        bool operator==(const Source&) const = default;
    };
    Source source;
    std::vector<Track> tracks;  // linear; of parameters that the scene had when it was read
    bool operator==(const ImportedCamera&) const = default;
};

/// Shared by the copies of a scene: some thousand frames.
struct SharedCamera {
    std::shared_ptr<const ImportedCamera> camera;  // null: no file
    std::vector<ParameterKey> overruled;           // by --set: `camera` has no tracks of these
    bool operator==(const SharedCamera& other) const {
        return camera == other.camera || (camera && other.camera && *camera == *other.camera);
    }
};

struct Scene {
    fs::path file;  // where it was loaded from; paths in it are already resolved against its folder
    OutputParams output;
    CameraParams camera;
    EnvironmentParams environment;
    double light_years_per_unit = 0.0;  // length of a scene unit in the sky; 0: unknown. Of [scene]
    ProvenanceParams provenance;
    std::vector<ReferenceParams> references;
    std::vector<LayerParams> layers;
    std::vector<Track> animation;
    SharedCamera imported;  // of camera.file; in no text
    bool operator==(const Scene&) const = default;
};

}  // namespace astrosplat
