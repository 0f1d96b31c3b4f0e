// A first scene around a picture: on a built-in shape, as `new --shape` writes it, or as bodies in depth, as
// `new` writes it and a dropped picture becomes. In: the picture and what kind of object it shows. Out: the
// scene file's text.
#pragma once

#include <glm/vec2.hpp>

#include "bodies/axis_fit.h"
#include "core/progress.h"
#include "objects/identify.h"
#include "source/source.h"

namespace astrosplat {

/// The commented text of a scene file `file` that shows `image` on a built-in shape: plane, relief, disk or
/// sphere; `scale`: of scale_text_of(). Throws InputError for another shape.
std::string new_scene_text(const fs::path& image, const std::string& shape, const fs::path& file,
                           const std::string& scale = "");

/// The lines that say how long a scene unit is where `image` is 10 units along its longer side; empty where
/// its file does not tell. Throws InputError where it cannot be read.
std::string scale_text_of(const fs::path& image);

/// Letters, digits and _ of a file's or person's name, beginning with a letter;
/// `otherwise` where none is left.
std::string layer_name_of(const std::string& text, const char* otherwise = "layer");

struct PictureScene {
    fs::path image;
    std::int64_t width_px = 0, height_px = 0;  // the picture's
    StructureKind structure = StructureKind::disk;
    SkyObject object = SkyObject::galaxy;
    std::vector<GalaxyParams> galaxies = {};  // how those of a disk lie, with all values
    std::optional<AxisFit> axis = {};         // of a body of revolution
    std::string lies_by = {};                 // because of what they lie so
    double lit_rim = 0.0;     // share of its rim beyond which what it shows goes on, as far as one can see
    double mean_light = 0.0;  // 0..1 of the displayed white
    double light_years_per_px = 0.0;  // at the object's distance; 0: unknown
    bool film = false;                // with a camera move of ten seconds
    /// That it passes close by, from the top left corner in shares of width and height.
    glm::dvec2 subject{0.5};
    fs::path stars = {};     // the table of those that `prepare` took away; empty: there is none
    double star_px = 1.0;    // standard deviation of their images, px of the picture
    fs::path starless = {};  // of PictureRequest
    bool parted = false;     // the table's stars are still in the picture, which is to be shown without them
};

/// A person's words on a picture.
struct PictureRequest {
    std::optional<SkyObject> as;             // what it is to be taken for
    const CatalogueObject* named = nullptr;  // the object that it shows
    fs::path starless = {};                  // the same without stars: then the picture shows them alone
    fs::path stars = {};  // the table of those; empty: what stars.csv beside the picture says
    std::int64_t most_texels =
        std::int64_t{4096} * 4096;  // to look at; more do not change what is seen in it
};

/// Reads the picture and what its file says, for its size and to choose a structure for it; `found`: what it
/// was taken for. The stars.csv that `prepare` wrote beside the picture (star_table_mark) is taken, too.
/// Throws InputError, Cancelled.
PictureScene picture_scene(const fs::path& image, const PictureRequest& request, Identification& found,
                           const Progress& progress = {});

/// Makes the stars of a table, if it has any, a layer of their own. Throws InputError, Cancelled.
void take_stars(PictureScene& scene, const fs::path& table, const Progress& progress = {});

/// The text of a scene in `file`. Its first frame is the picture itself, filled exactly; with a film the
/// camera holds it, tilts, passes close by and flies on.
std::string picture_scene_text(const PictureScene& scene, const fs::path& file);

}  // namespace astrosplat
