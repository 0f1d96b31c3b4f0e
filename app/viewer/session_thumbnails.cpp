// Textures are made of what is seen alone: a folder may hold more pictures than a GPU has memory for.
#include "viewer/session_thumbnails.h"

#include <algorithm>
#include <memory>

namespace astrosplat {

void show_thumbnails(Session& session) {
    const std::vector<ListedPicture>& seen = session.view.listed_pictures;
    std::map<ListedPicture, ListedThumbnail>& shown = session.status.thumbnails;
    session.thumbnails.want(seen);
    const auto is_gone = [&](const auto& entry) {
        return std::ranges::find(seen, entry.first) == seen.end();
    };
    std::erase_if(shown, is_gone);
    std::erase_if(session.thumbnail_textures, is_gone);
    for (const ListedPicture& picture : seen) {
        if (shown.count(picture)) continue;
        const std::shared_ptr<const Thumbnail> found = session.thumbnails.found(picture);
        if (!found) continue;
        ListedThumbnail& thumbnail = shown[picture];
        if (found->rgb.empty()) continue;
        ImageTexture& texture = session.thumbnail_textures[picture];
        texture.upload_smooth(to_image(*found));
        thumbnail = {to_handle(texture.handle()), found->width, found->height};
    }
}

}  // namespace astrosplat
