# Finds Debian's packages. OpenImageIO comes by pkg-config because Debian's CMake config for it needs packages that
# nothing here uses.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
find_package(pugixml REQUIRED)
find_package(PNG REQUIRED)
find_package(TIFF 4.5 REQUIRED)
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR>=3.1)
pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)
pkg_check_modules(CFITSIO REQUIRED IMPORTED_TARGET cfitsio)
pkg_check_modules(WCSLIB REQUIRED IMPORTED_TARGET wcslib)
pkg_check_modules(ERFA REQUIRED IMPORTED_TARGET erfa)
pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
if(ASTROSPLAT_WINDOW)
  find_package(glfw3 3.3 REQUIRED)
  find_package(OpenGL REQUIRED COMPONENTS EGL)
  pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
endif()

# lazy_library(NAME PREFIX LIBRARY PATTERN): the target NAME stands for a shared library that is loaded when the first of
# its functions that match is called. Sanitizers look at the classes' type information, so there it is linked.
function(lazy_library name prefix library pattern)
  if(NOT (CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND CMAKE_SYSTEM_NAME STREQUAL "Linux") OR ASTROSPLAT_SANITIZE)
    add_library(${name} ALIAS PkgConfig::${prefix})
    return()
  endif()
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  find_library(${prefix}_LIBRARY ${library} HINTS ${${prefix}_LIBRARY_DIRS} REQUIRED)
  set(loader ${PROJECT_BINARY_DIR}/lazy_${name}.c)
  set(script ${PROJECT_SOURCE_DIR}/third_party/lazy_library.py)
  add_custom_command(OUTPUT ${loader} COMMAND Python3::Interpreter ${script} ${${prefix}_LIBRARY} ${loader} ${pattern}
    DEPENDS ${${prefix}_LIBRARY} ${script} COMMENT "Generating the loader of ${library}" VERBATIM)
  add_library(${name} STATIC ${loader})
  target_include_directories(${name} SYSTEM PUBLIC ${${prefix}_INCLUDE_DIRS})
  target_compile_options(${name} PUBLIC ${${prefix}_CFLAGS_OTHER})
  target_link_libraries(${name} PRIVATE Threads::Threads ${CMAKE_DL_LIBS})
endfunction()

# oiio: OpenImageIO as the engine links it. Loading it with the 250 libraries it needs takes a fifth of a second and 100
# MB, so it waits for the first picture. Its small companion, libOpenImageIO_Util, is linked as usual.
lazy_library(oiio OIIO OpenImageIO
  "^_ZNK?[0-9]+OpenImageIO_v[0-9_]*(10ImageInput|11ImageOutput|9ImageSpec|8geterror|9attribute|11decode_exif)")
get_target_property(linked_oiio oiio ALIASED_TARGET)
if(NOT linked_oiio)
  find_library(OIIO_UTIL_LIBRARY OpenImageIO_Util HINTS ${OIIO_LIBRARY_DIRS} REQUIRED)
  target_link_libraries(oiio PUBLIC ${OIIO_UTIL_LIBRARY})
endif()
# ocio: few scenes name a configuration.
lazy_library(ocio OCIO OpenColorIO
  "^_ZNK?[0-9]+OpenColorIO_v[0-9_]*(6Config|[0-9]+[A-Za-z]*Processor|13GpuShaderDesc|16GpuShaderCreator|15PackedImageDesc|[0-9]+[A-Za-z]*Transform[0-9DC]|10ColorSpace|10GetVersion|14ClearAllCaches|15SetLogging)")

# OpenGL's function loader is generated in the build from the Khronos registry that Debian's glad brings; without
# --reproducible it would ask the network for a newer one.
if(ASTROSPLAT_WINDOW)
  find_program(GLAD_COMMAND glad REQUIRED)
  set(glad_folder ${PROJECT_BINARY_DIR}/glad)
  add_custom_command(
    OUTPUT ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h ${glad_folder}/include/KHR/khrplatform.h
    COMMAND ${GLAD_COMMAND} --api gl:core=4.5 --extensions "" --reproducible --quiet --out-path ${glad_folder} c
    COMMENT "Generating the OpenGL loader" VERBATIM)
  add_library(glad STATIC ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h)
  target_include_directories(glad SYSTEM PUBLIC ${glad_folder}/include)
endif()

# openvdb: Debian has no CMake config for it, only a module with packages that nothing here uses.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OPENVDB_LIBRARY openvdb REQUIRED)
find_library(TBB_LIBRARY tbb REQUIRED)
pkg_check_modules(IMATH REQUIRED IMPORTED_TARGET Imath)
add_library(openvdb INTERFACE)
target_include_directories(openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR})
target_link_libraries(openvdb INTERFACE ${OPENVDB_LIBRARY} ${TBB_LIBRARY} PkgConfig::IMATH)

# For --version, of those that have a say in pictures or files.
set(astrosplat_library_versions "OpenEXR ${OPENEXR_VERSION}" "OpenImageIO ${OIIO_VERSION}" "OpenColorIO ${OCIO_VERSION}"
  "CFITSIO ${CFITSIO_VERSION}" "WCSLIB ${WCSLIB_VERSION}" "ERFA ${ERFA_VERSION}" "Little CMS ${LCMS_VERSION}" "Highway ${HWY_VERSION}" "fmt ${fmt_VERSION}" "zlib ${ZLIB_VERSION_STRING}"
  "libpng ${PNG_VERSION_STRING}" "libtiff ${TIFF_VERSION_STRING}" "OpenSSL ${OPENSSL_VERSION}")
if(ASTROSPLAT_WINDOW)
  list(APPEND astrosplat_library_versions "GLFW ${glfw3_VERSION}" "Dear ImGui ${IMGUI_VERSION}")
endif()
