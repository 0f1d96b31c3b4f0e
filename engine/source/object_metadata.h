// Metadata of the object in a picture's file: AVM, the metadata that ESA, ESO, NASA and their telescopes
// write into published pictures (Astronomy Visualization Metadata 1.2, in an XMP packet), or the cards of a
// FITS header. In: a file. Out: plain values.
#pragma once

#include "core/standard.h"

namespace astrosplat {

struct ObjectMetadata {
    std::vector<std::string> categories;   // Subject.Category, such as "C.5.1.1"
    std::vector<std::string> names;        // Subject.Name, or OBJECT: "M 104", "Sombrero Galaxy"
    std::string title, credit;             // as the file has them, in its first language
    std::string type;                      // "Observation", "Artwork", "Simulation" ...; may be empty
    std::optional<double> distance_ly;     // light years, above 0, at most 1e12
    std::optional<double> degrees_per_px;  // along the picture's width, > 0
    std::array<double, 2> reference_px{};  // width and height of the picture that the scale is of; 0: unknown
    std::optional<double> north_angle;     // degrees, of north counter-clockwise from up, also where the
                                           // picture is mirrored; -180 to 180
    std::optional<std::array<double, 2>>
        sky_position;  // degrees: right ascension, declination of a place in it
    bool operator==(const ObjectMetadata&) const = default;
};

/// Of the first XMP packet with AVM, else of the first one, in the first or last 4 MiB of the file: JPEG, PNG
/// and TIFF keep packets uncompressed, so that they can be found without knowing the format (XMP
/// specification, part 3, packet scanning). Nothing where there is none, or none that is XML. Throws
/// InputError where the file cannot be read.
ObjectMetadata read_xmp_metadata(const fs::path& file);

/// The same of bytes in which packets stand.
ObjectMetadata find_xmp_metadata(std::string_view bytes);

/// A packet that says the same, for pictures made of one; empty where there is nothing to say. Angles and
/// scales may differ in their last bits.
std::string xmp_packet(const ObjectMetadata& metadata);

/// Of the HDU of a FITS file that is taken for the picture: OBJECT, DISTANCE, and how the sky lies on it.
/// Throws InputError.
ObjectMetadata read_fits_metadata(const fs::path& file);

/// How wide one pixel of a picture of this size is on the sky, in degrees: the scale is of the reference's
/// pixels, which the picture may have reduced, or cut to other proportions after it was reduced to cover
/// them. Nothing where none is known, or the picture would be wider or higher than the whole sky.
std::optional<double> degrees_per_px_of(const ObjectMetadata& metadata, double width_px, double height_px);

}  // namespace astrosplat
