// Metadata of the object in a picture's file: AVM, the metadata that ESA, ESO, NASA and their telescopes
// write into published pictures (Astronomy Visualization Metadata 1.2, in an XMP packet), or the cards of a
// FITS header. In: a file. Out: plain values, those of several pictures put together, and a packet again.
#pragma once

#include <span>

#include "core/standard.h"

namespace astrosplat {

/// One exposure that a picture was made of, as AVM says it: Facility, Instrument, Spectral.ColorAssignment,
/// Spectral.Band, Spectral.Bandpass, Spectral.CentralWavelength (nm). Empty where the file does not say.
using SpectralBlock = std::array<std::string, 6>;

struct ObjectMetadata {
    std::vector<std::string> categories;   // Subject.Category, such as "C.5.1.1"
    std::vector<std::string> names;        // Subject.Name, or OBJECT: "M 104", "Sombrero Galaxy"
    std::string title, credit;             // as the file has them, in its first language
    std::string type;                      // "Observation", "Artwork", "Simulation" ...; may be empty
    std::string id;                        // of the picture; only written
    std::vector<SpectralBlock> spectra;    // the picture's colours in their order
    std::vector<std::string> urls;         // ReferenceURL: pages about the picture
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
/// scales may differ in their last bits. Texts become utf8_line()s.
std::string xmp_packet(const ObjectMetadata& metadata);

/// What can be said of something made of several pictures: titles and credits joined, each once; categories,
/// names, spectra and pages of all, each once; a distance that no two of them see otherwise; the type
/// "Simulation" where all of them are, else "Artwork". Nothing on the sky: it holds for none but the picture.
/// Of hundreds of pictures lists end after 256 values, and titles after 8; credits are whole.
ObjectMetadata merged_metadata(std::span<const ObjectMetadata> pictures);

/// A property of AVM in words: of "image" the "web page". Values that say nothing are left out.
struct AvmTag {
    std::string group, name;
    std::vector<std::string> values;
};
/// All of the packet that find_xmp_metadata() takes, in the order of the standard, then what it does not
/// know.
std::vector<AvmTag> find_avm_tags(std::string_view bytes);
std::vector<AvmTag> read_avm_tags(const fs::path& file);

/// Of the HDU of a FITS file that is taken for the picture: OBJECT, DISTANCE, and how the sky lies on it.
/// Throws InputError.
ObjectMetadata read_fits_metadata(const fs::path& file);

/// How wide one pixel of a picture of this size is on the sky, in degrees: the scale is of the reference's
/// pixels, which the picture may have reduced, or cut to other proportions after it was reduced to cover
/// them. Nothing where none is known, or the picture would be wider or higher than the whole sky.
std::optional<double> degrees_per_px_of(const ObjectMetadata& metadata, double width_px, double height_px);

}  // namespace astrosplat
