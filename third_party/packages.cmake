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
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
pkg_check_modules(CFITSIO REQUIRED IMPORTED_TARGET cfitsio)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
find_package(glfw3 3.3 REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS EGL)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)

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
