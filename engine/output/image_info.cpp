#include "output/image_info.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/open_picture.h"

namespace astrosplat {

ImageInfo read_image_info(const std::filesystem::path& file) {
    const auto in = open_picture(file);
    const OIIO::ImageSpec& spec = in->spec();
    ImageInfo info{spec.width,       spec.height,       spec.x, spec.y, spec.full_width,
                   spec.full_height, in->format_name(), {},     {}};
    for (int c = 0; c < spec.nchannels; ++c) {
        info.channels.emplace_back(spec.channel_name(c), spec.channelformat(c).c_str());
    }
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        info.metadata.emplace_back(value.name().string(), value.get_string());
    }
    return info;
}

}  // namespace astrosplat
