// The values of [layer.source] in a scene file; what is left out there has the defaults here.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/text.h"

namespace astrosplat {

enum class SourceKind { mesh, splats, stars };
constexpr auto names_of(SourceKind) { return names_up_to<SourceKind::stars>("mesh", "splats", "stars"); }

/// A map made of a picture's own light, 0..1: derived_picture() in texture.h.
enum class Derived { none, dust, h_alpha, young_stars };
constexpr auto names_of(Derived) {
    return names_up_to<Derived::young_stars>("none", "dust", "h_alpha", "young_stars");
}

/// Where a mask shows a picture: everywhere that all of its terms hold; empty terms hold everywhere.
struct MaskTerms {
    std::optional<glm::dvec2> luminance;   // [lo, hi] of the displayed luminance; 0 and 1 have no edge
    std::optional<glm::dvec2> hue;         // degrees, [from, to] of the displayed colour; may pass 360
    std::optional<glm::dvec2> saturation;  // [lo, hi] of the displayed colour's (HSV)
    std::optional<glm::dvec4> ellipse;     // u, v of its centre and its half axes in picture widths
    double turn = 0.0;                     // degrees that the ellipse is turned, counter-clockwise
    fs::path image;                        // grey picture over the whole texture, as stored
    Derived derive = Derived::none;        // weighs by this map; `luminance` is then of its values
    double feather = 0.0;                  // width of a soft edge: 0..1 of the range, turns, picture widths
    bool invert = false;
    bool operator==(const MaskTerms&) const = default;
};

/// Its own terms, and at least one of the alternatives where there are any.
struct MaskParams : MaskTerms {
    std::vector<MaskTerms> any;
    bool operator==(const MaskParams&) const = default;
};

/// How a picture is made ready before anything else is made of it: the command `prepare`, in this order.
struct PrepareParams {
    enum class Stars { keep, remove };
    friend constexpr auto names_of(Stars) { return names_up_to<Stars::remove>("keep", "remove"); }
    enum class Background { keep, level, plane, curved };
    friend constexpr auto names_of(Background) {
        return names_up_to<Background::curved>("keep", "level", "plane", "curved");
    }
    fs::path align;     // FITS picture on whose grid of the sky it is put; empty: as it is
    fs::path starless;  // picture of its size: the same without stars, and it is the stars alone
    fs::path fill;      // picture of its size: what is not black is filled from around it
    Stars stars = Stars::keep;
    double threshold = 5.0;            // least height of a star over the local noise
    std::optional<double> saturation;  // linear light; empty: 0.98 of pictures of integers, none of others
    Background background = Background::keep;  // taken off as a level, a slope or one that bends
    bool lupton = false;                       // one asinh for all three channels in place of the stretch
    double q = 8.0;                            // lupton: how early it bends
    double lupton_stretch = 0.1;               // lupton: intensity shown at a tenth of white
    std::optional<glm::dvec4> ellipse;         // px from the top left: centre and half axes of what stays
    double turn = 0.0;                         // degrees that the ellipse is turned, counter-clockwise
    double feather = 0.1;                      // share of its half axes over which it fades
    fs::path mask;                             // picture of its size: what is black is cut off
    std::optional<glm::dvec2> alpha;           // luminance where alpha becomes 0 and 1
    bool operator==(const PrepareParams&) const = default;
};

/// Whether any of it is asked for.
inline bool prepares(const PrepareParams& p) {
    return !p.align.empty() || !p.starless.empty() || !p.fill.empty() ||
           p.stars == PrepareParams::Stars::remove || p.background != PrepareParams::Background::keep ||
           p.lupton || p.ellipse || !p.mask.empty() || p.alpha;
}

/// How a picture file becomes linear, premultiplied colour.
struct TextureSettings {
    enum class Colorspace { automatic, srgb, linear };
    friend constexpr auto names_of(Colorspace) {
        return names_up_to<Colorspace::linear>("auto", "srgb", "linear");
    }
    enum class Alpha { automatic, file, luminance, max, one };
    friend constexpr auto names_of(Alpha) {
        return names_up_to<Alpha::one>("auto", "file", "luminance", "max", "one");
    }
    enum class Unpremultiply { automatic, yes, no };
    friend constexpr auto names_of(Unpremultiply) {
        return names_up_to<Unpremultiply::no>("auto", "true", "false");
    }
    enum class Stretch { automatic, linear, asinh, log };
    friend constexpr auto names_of(Stretch) {
        return names_up_to<Stretch::log>("auto", "linear", "asinh", "log");
    }
    enum class Wrap { automatic, repeat, clamp, black };
    friend constexpr auto names_of(Wrap) {
        return names_up_to<Wrap::black>("auto", "repeat", "clamp", "black");
    }
    enum class Filter { bilinear, nearest, area };
    friend constexpr auto names_of(Filter) {
        return names_up_to<Filter::area>("bilinear", "nearest", "area");
    }
    Colorspace colorspace = Colorspace::automatic;
    Alpha alpha = Alpha::automatic;
    Unpremultiply unpremultiply = Unpremultiply::automatic;
    std::string hdu = "auto";  // of several pictures in a file: "auto", a number or a name
    std::optional<int> plane;  // FITS cubes: plane, from 0; empty: as open_fits_rows() has it
    Stretch stretch = Stretch::automatic;
    std::optional<double> black;  // data value shown as 0; empty: the 0.25 percentile of finite pixels
    std::optional<double> white;  // data value shown as 1; empty: the 99.75 percentile
    double softening = 0.1;       // asinh(x/s)/asinh(1/s)
    Filter filter = Filter::bilinear;
    Wrap wrap = Wrap::automatic;
    Derived derive = Derived::none;  // shows this map instead of the picture
    double smooth = 0.0;             // standard deviation of a blur, of the picture's width
    double detail = 0.0;             // leaves what a blur of that width takes away; 0: everything
    std::vector<MaskParams> mask;    // multiply alpha
    PrepareParams prepare;           // comes before all that the picture's own values do not need
    bool operator==(const TextureSettings&) const = default;
};

/// Measures of the built-in shapes (textured_mesh.h), each of the shapes it names.
struct ShapeParams {
    std::vector<glm::vec2> outline;  // revolution: (r, y) from end to end, scene units
    double width = 0.5;              // hourglass: radius of a lobe without its share of the waist, of 5
    double waist = 0.3;              // hourglass: 0 figure eight .. 1 spheroid
    double thickness = 0.2;          // shell: between its walls, of the radius
    double opening = 60.0;           // bubble: degrees from the axis to its rim
    double flattening = 0.0;         // spheroid: 1 - height / width
    int shells = 1;                  // spheroid: how many are nested
    double concentration = 3.0;      // spheroid: their number per length falls as e^(-this r / R)
    double tube = 0.2;               // ring: radius of the tube, of the whole
    fs::path depth_map;              // sheet: grey, black farthest, or distances (Z); empty: the brightness
    double depth = 0.15;             // sheet: from farthest to nearest, of the width
    double blur = 0.01;              // sheet: standard deviation, of the longer side
    bool operator==(const ShapeParams&) const = default;
};

/// One mesh of a layer with its picture. `mesh` is a file or one of mesh.h's builtin_meshes.
struct MeshInput {
    fs::path mesh;
    std::vector<fs::path>
        texture;           // empty: the mesh's own map_Kd, else neutral grey; three: one picture from r, g, b
    double relief = 0.15;  // "relief": height as a fraction of the plane's width
    ShapeParams shape = {};
    bool operator==(const MeshInput&) const = default;
};

/// The parts of a star's image besides its core, each with its share of the light.
struct StarWings {
    double share = 0.0;  // 0..1
    double px = 3.0;
    double power = 2.5;  // > 1: (1 + (r / px)^2)^-power
    bool operator==(const StarWings&) const = default;
};
struct StarSpikes {
    double share = 0.0;  // 0..1
    int vanes = 4;
    double angle = 0.0;  // degrees
    double px = 40.0;    // length at which a spike has fallen to 1/e
    bool operator==(const StarSpikes&) const = default;
};

/// kind stars: a catalogue, the stars of a picture, or `SourceParams::count` random stars along something.
inline constexpr double parsec_ly = 3.261563777;  // light years, by the definitions of the IAU

struct StarsParams {
    enum class Depth { layer, magnitude };
    friend constexpr auto names_of(Depth) { return names_up_to<Depth::magnitude>("layer", "magnitude"); }
    fs::path catalogue;
    std::string like;            // name of the layer whose picture they are of; empty: of none
    Depth depth = Depth::layer;  // like: at random, or the brighter the nearer
    double slab = 0.0;           // like: scene units, nearest to farthest; 0: as the layer's own stars
    std::optional<double> unit;  // scene units per parsec; none: by the scene's light years, else 1
    double limit = 12.0;         // faintest magnitude of the catalogue
    double zero_point = 4.0;     // magnitude of flux 1
    std::string along;           // "camera": random stars around the camera's path; empty: the catalogue
    double spread = 10.0;        // scene units around the path
    double psf = 1.0;            // px, standard deviation
    StarWings wings;
    StarSpikes spikes;
    std::vector<glm::dvec3> path;  // for `along`, scene units. Not a key: the camera's
    /// For `like`: the seed of that layer, whose source is then the rest of SourceParams. Not a key.
    std::uint32_t like_seed = 0;
    bool operator==(const StarsParams&) const = default;
};

enum class UvMode { mesh, planar_xy, planar_xz, planar_yz, camera };
constexpr auto names_of(UvMode) {
    return names_up_to<UvMode::camera>("mesh", "planar-xy", "planar-xz", "planar-yz", "camera");
}

/// The camera that took a picture (uv = "camera"), in the meshes' own space.
struct UvCamera {
    std::optional<glm::dvec3> position;  // scene units; has to be given
    glm::dvec3 target{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double fov = 45.0;    // degrees, from the picture's bottom to its top
    double height = 0.0;  // scene units, the same where rays are parallel; 0: they meet, under fov
    bool operator==(const UvCamera&) const = default;
};

/// How a picture fills the neighbourhood of its mesh (DEPTH 7): columns extrudes it, the others make bodies.
enum class StructureKind { columns, disk, sheet, walls, axis };
constexpr auto names_of(StructureKind) {
    return names_up_to<StructureKind::axis>("columns", "disk", "sheet", "walls", "axis");
}

/// Inclination from which a picture cannot tell all of a disk's plane, degrees.
inline constexpr double hidden_from_deg = 66.0;

/// How a galaxy lies in its picture; empty: found when its set is made.
struct GalaxyParams {
    std::optional<double> inclination = 0.0;  // degrees, 0 face-on .. 90 edge-on
    std::optional<double> position_angle;     // of the major axis, degrees from right counter-clockwise
    std::optional<glm::dvec2> center;         // u, v in the picture, 0..1
    std::optional<double> near_side;          // direction that is nearer, degrees counter-clockwise
    std::optional<double> bulge;              // share of the light that is the spheroid's
    bool operator==(const GalaxyParams&) const = default;
};

struct StructureParams {
    enum class Stars { automatic, yes, no };
    friend constexpr auto names_of(Stars) { return names_up_to<Stars::no>("auto", "true", "false"); }
    StructureKind kind = StructureKind::columns;
    double height =
        0.0;  // scene units, scale height; 0: 1.8 % of the picture's longest side for a disk, else 1.1 %
    double depth = 0.15;  // of the picture's width: whole depth of walls, or of a flat sheet's relief
    double clumps = 1.0;  // how strongly depths follow the noise
    double flare = 0.0;   // disk: scale height at the rim over that in the middle, less 1
    double warp = 0.0;    // disk: of the width, how far its plane rises at the rim, and sinks opposite
    GalaxyParams galaxy;  // disk: the only one of its picture
    std::vector<GalaxyParams> galaxies;  // disk: or several, each with a centre
    double spiral = 1.0;                 // disk: of the arms invented where the picture cannot tell its plane
    /// Axis, degrees: in the picture, from right counter-clockwise; and how far that end of it leans out of
    /// the picture towards the viewer, -80..80. Empty: as the picture's symmetry has it.
    std::optional<double> axis_angle, tilt;
    Stars stars =
        Stars::automatic;  // found and made into single splats; automatic: unless prepare removes them
    std::optional<double>
        dust;               // share of the dark details that absorb; empty: four fifths in a disk, else 0
    double opacity = 0.55;  // power of brightness that opacity grows with
    double density = 0.75;  // opacity of white
    double border = 0.0;    // of the width, over which light fades towards the picture's edges
    double margin = 0.0;    // of the width, by which the picture is continued beyond its edges
    int detail = 0;         // octaves below the picture's texels, 0..2, that are invented (DETAIL)
    /// Where: rows of tiles with a blank between, each with so many octaves (at most `detail`), which
    /// together are the picture without its margin. Empty: everywhere.
    std::string detail_tiles;
    double detail_strength = 0.8;  // of the noise among them
    std::int64_t most_texels = 0;  // that a picture is reduced to; 0: all. Not a key: follows from --memory
    bool operator==(const StructureParams&) const = default;
};

/// Planar uv: what the half of a mesh that lies behind its middle shows.
enum class BackWall { same, mirrored, varied };
constexpr auto names_of(BackWall) { return names_up_to<BackWall::varied>("same", "mirrored", "varied"); }

struct SourceParams {
    SourceKind kind = SourceKind::mesh;
    std::vector<MeshInput> meshes;
    TextureSettings texture;
    std::optional<glm::dvec3> buffer;    // scene units; empty: max_distance
    std::optional<glm::i64vec3> voxels;  // empty: from voxel_size, or automatic
    double voxel_size = 0.0;             // scene units; 0: from voxels, or automatic
    std::int64_t count = 2000000;        // positions kept by automatic voxels, about
    std::int64_t splats = 0;             // in place of count: positions left after alpha and masks; 0: count
    double jitter = 1.0;                 // 0..1 of half a voxel
    double max_distance = 0.0;           // scene units; 0: 2 % of the longest side of the meshes' box
    UvMode uv = UvMode::mesh;
    double uv_width = 0.0;           // planar: scene units that a picture's width covers; 0: the meshes' box
    glm::dvec3 uv_center{0.0};       // planar with uv_width: where the picture's middle lies
    BackWall back = BackWall::same;  // planar
    UvCamera uv_camera;
    StructureParams structure;
    std::uint32_t seed = 0;  // 0: derived from the layer's name
    fs::path file;           // kind splats
    StarsParams stars;       // kind stars
    bool operator==(const SourceParams&) const = default;
};

/// Whether bodies are to look for stars: by themselves, not where the picture was rid of them before.
inline bool finds_stars(const SourceParams& source) {
    if (source.structure.stars != StructureParams::Stars::automatic)
        return source.structure.stars == StructureParams::Stars::yes;
    return source.texture.prepare.stars != PrepareParams::Stars::remove;
}

}  // namespace astrosplat
