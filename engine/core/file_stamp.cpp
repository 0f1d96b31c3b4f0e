#include "core/file_stamp.h"

#include <sys/stat.h>

namespace astrosplat {

FileStamp stamp_of(const std::filesystem::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return {};
    return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size, status.st_dev, status.st_ino};
}

}  // namespace astrosplat
