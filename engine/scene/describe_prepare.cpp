#include "scene/describe_prepare.h"

#include <algorithm>

namespace astrosplat {

using Type = ParameterType;
using namespace traits;

void describe_fits(const Describer& d, TextureSettings& t) {
    d.custom(
        spec("hdu", "FITS HDU", "", "Number or EXTNAME of the HDU; auto: the first with a picture.",
             as(Type::text)),
        [&t](const ParameterSpec&) {
            const bool number =
                is_list_index(t.hdu) && t.hdu.size() < 10 && (t.hdu[0] != '0' || t.hdu == "0");
            return number ? Value(static_cast<std::int64_t>(std::stol(t.hdu))) : Value(t.hdu);
        },
        [&t](const Value& value, const ParameterSpec& s) {
            const bool number = std::holds_alternative<std::int64_t>(value.data);
            t.hdu = number ? to_toml(value) : text_of(value, s);
        });
    d(t.plane, "plane", "FITS plane", "", "Plane of a FITS cube, from 0.", at_least(0), slider(0, 100));
    d(t.stretch, "stretch", "Stretch", "",
      "Curve from data values to display values; auto: asinh for FITS, linear else.");
    d(t.black, "black", "Black point", "data values", "Data value shown as 0; auto: the 0.25 percentile.",
      or_auto(), within(-1e30, 1e30), slider(0, 1));
    d(t.white, "white", "White point", "data values", "Data value shown as 1; auto: the 99.75 percentile.",
      or_auto(), within(-1e30, 1e30), slider(0, 1));
    d(t.softening, "softening", "Softening", "", "Where the asinh stretch turns from linear to logarithmic.",
      within(1e-9, 1e9), slider(0.001, 1), logarithmic());
}

void describe_prepare(const Describer& d, PrepareParams& p) {
    d(p.align, "align", "Align with", "",
      "FITS picture of the same field: this one is put on its grid of the sky.");
    d(p.fill, "fill", "Fill", "",
      "Picture of the same size: what is not black in it is filled from its surroundings.");
    d(p.stars, "stars", "Stars", "", "Kept, or removed: what they hid is filled from around them.");
    const Describer removal = d.only_with("stars", {"remove"});
    removal(p.threshold, "threshold", "Threshold", "times the noise", "Least height of a star.",
            within(0.01, 1e9), slider(2, 20));
    removal(p.saturation, "saturation", "Saturation", "linear light",
            "Where the picture saturates; auto: 0.98 in 8 and 16 bit, nowhere in others.", or_auto(),
            within(1e-9, 1e9), slider(0.1, 1));
    d(p.background, "background", "Background", "",
      "Kept, or taken off as a level, a slope (plane) or one that bends (curved).");
    d(p.lupton, "lupton", "Lupton", "",
      "One asinh of the mean for all three channels in place of the stretch: bright parts keep their "
      "colour.");
    const Describer bent = d.only_with("lupton", {true});
    bent(p.q, "q", "Q", "", "How early that asinh bends.", within(1e-6, 1e6), slider(0.1, 100),
         logarithmic());
    bent(p.lupton_stretch, "lupton_stretch", "Lupton stretch", "of the white point",
         "Intensity it shows at a tenth of white.", within(1e-9, 1e9), slider(0.001, 1), logarithmic());
    d(p.ellipse, "ellipse", "Ellipse", "px",
      "Centre from the top left and half axes of what stays, the rest is cut off; []: everything.",
      within(-1e6, 1e6), slider(0, 4000));
    const Describer edge = d.never_with("ellipse", {Value()});
    edge(p.turn, "turn", "Turn", "degrees", "Turns the ellipse counter-clockwise.", slider(-180, 180));
    edge(p.feather, "feather", "Feather", "of the half axes", "Over which it fades, inwards.", range(0, 1));
    d(p.mask, "mask", "Mask picture", "", "Picture of the same size: what is black in it is cut off.");
    d(p.alpha, "alpha", "Alpha", "luminance", "From, to: alpha from luminance, 0 to 1; []: none.",
      within(-1e6, 1e6), slider(0, 1));
}

Description describe_preparation(TextureSettings& t) {
    Description description;
    const Describer d(description, {}, false);
    describe_fits(d, t);
    describe_prepare(d, t.prepare);
    return description;
}

std::string prepare_option(const ParameterKey& key) {
    if (key == "q") return "--lupton-q";  // newer CLI11 takes --q for -q
    std::string option = "--" + key.text();
    std::ranges::replace(option, '_', '-');
    return option;
}

}  // namespace astrosplat
