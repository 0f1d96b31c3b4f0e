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
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
pkg_check_modules(CFITSIO REQUIRED IMPORTED_TARGET cfitsio)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
find_package(glfw3 3.3 REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS EGL)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)

# oiio: OpenImageIO as the engine links it. Loading it with the 250 libraries it needs takes a fifth of a second and 100
# MB, so it waits for the first picture: functions of these classes are bound when one is called. Its small companion,
# libOpenImageIO_Util, is linked as usual. Sanitizers look at the classes' type information, so there it is linked too.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT ASTROSPLAT_SANITIZE)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  find_library(OIIO_LIBRARY OpenImageIO HINTS ${OIIO_LIBRARY_DIRS} REQUIRED)
  find_library(OIIO_UTIL_LIBRARY OpenImageIO_Util HINTS ${OIIO_LIBRARY_DIRS} REQUIRED)
  set(lazy_oiio ${PROJECT_BINARY_DIR}/lazy_oiio.c)
  set(lazy_script ${PROJECT_SOURCE_DIR}/third_party/lazy_library.py)
  add_custom_command(
    OUTPUT ${lazy_oiio}
    COMMAND Python3::Interpreter ${lazy_script} ${OIIO_LIBRARY} ${lazy_oiio}
      "^_ZNK?[0-9]+OpenImageIO_v[0-9_]*(10ImageInput|11ImageOutput|9ImageSpec|8geterror|9attribute)"
    DEPENDS ${OIIO_LIBRARY} ${lazy_script} COMMENT "Generating the loader of OpenImageIO" VERBATIM)
  add_library(oiio STATIC ${lazy_oiio})
  target_include_directories(oiio SYSTEM PUBLIC ${OIIO_INCLUDE_DIRS})
  target_compile_options(oiio PUBLIC ${OIIO_CFLAGS_OTHER})
  target_link_libraries(oiio PUBLIC ${OIIO_UTIL_LIBRARY} PRIVATE Threads::Threads ${CMAKE_DL_LIBS})
else()
  add_library(oiio ALIAS PkgConfig::OIIO)
endif()

# OpenGL's function loader is generated in the build from the Khronos registry that Debian's glad brings; without
# --reproducible it would ask the network for a newer one.
find_program(GLAD_COMMAND glad REQUIRED)
set(glad_folder ${PROJECT_BINARY_DIR}/glad)
add_custom_command(
  OUTPUT ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h ${glad_folder}/include/KHR/khrplatform.h
  COMMAND ${GLAD_COMMAND} --api gl:core=4.5 --extensions "" --reproducible --quiet --out-path ${glad_folder} c
  COMMENT "Generating the OpenGL loader" VERBATIM)
add_library(glad STATIC ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h)
target_include_directories(glad SYSTEM PUBLIC ${glad_folder}/include)
