#include "scene_texts.h"

namespace astrosplat::test {

const char* const full_scene = R"toml(astrosplat = 1

[output]
preset = ""
resolution = [1920, 1080]
frames = "1-240"
fps = 24.0
path = "frames/shot.####.exr"
depth = "auto"
compression = "auto"
alpha = "auto"
primaries = "rec709"
aovs = []
view = "auto"
exposure = 0.0
pixel_filter = 0.5
samples = 32
ocio = { config = "", display = "", view = "", space = "" }

[camera]
projection = "perspective"
position = []
target = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
rotation = []
roll = 0.0
fov = 45.0
focal_length = 0.0
film_width = 36.0
shift = [0.0, 0.0]
fisheye_fov = 180.0
fisheye_tilt = 0.0
panorama_fov = 360.0
shutter = 0.0
f_number = 0.0
focus_distance = 0.0
unit_mm = 1000.0
eye = "centre"
eye_separation = 0.065
convergence = 0.0
height = 10.0
near = 0.01
far = 0.0
near_fade = 0.0
file = ""
file_scale = 1.0
file_up = "auto"
file_offset = 0.0
file_fps = 0.0

[environment]
image = ""
cube = []
gain = 1.0
rotation = [0.0, 0.0, 0.0]
behind = 0.0
visible = true
tile = ""
tile_height = 10.0
tile_seed = 1
tile_px = 2048

[provenance]
title = ""
credit = ""
type = "Artwork"

[scene]
light_years_per_unit = 0.0

[[reference]]
file = ""
view = "any"
frames = ""
position = [0.0, 0.0]
scale = 1.0
rotate = 0.0
mirrored = false
opacity = 1.0

[[layer]]
name = "stars"
visible = true
axis = [0.0, 1.0, 0.0]
preset = ""

[layer.transform]
translate = [0.0, 0.0, 0.0]
rotate = [0.0, 0.0, 0.0]
scale = 1.0

[layer.source]
kind = "mesh"
meshes = [ { mesh = "disk.obj", texture = "", relief = 0.15, outline = [], width = 0.5, waist = 0.3, thickness = 0.2, opening = 60.0, flattening = 0.0, shells = 1, concentration = 3.0, tube = 0.2, depth_map = "", depth = 0.15, blur = 0.01 } ]

colorspace = "auto"
alpha = "auto"
unpremultiply = "auto"
hdu = "auto"
stretch = "auto"
black = "auto"
white = "auto"
softening = 0.1
buffer = "auto"
voxels = "auto"
count = 2000000
splats = 0
jitter = 1.0
max_distance = 0.0
filter = "bilinear"
wrap = "auto"
prepare = { align = "", fill = "", stars = "keep", threshold = 5.0, saturation = "auto", background = "keep", lupton = false, q = 8.0, lupton_stretch = 0.1, ellipse = [], turn = 0.0, feather = 0.1, mask = "", alpha = [] }
derive = "none"
smooth = 0.0
detail = 0.0
mask = [ { luminance = [], hue = [], saturation = [], ellipse = [], turn = 0.0, image = "", derive = "none", feather = 0.0, invert = false, any = [ { luminance = [], hue = [], saturation = [], ellipse = [], turn = 0.0, image = "", derive = "none", feather = 0.0, invert = false } ] } ]
uv = "mesh"
uv_width = 0.0
uv_center = [0.0, 0.0, 0.0]
back = "same"
uv_camera = { position = [], target = [0.0, 0.0, 0.0], up = [0.0, 1.0, 0.0], fov = 45.0, height = 0.0 }
structure = { kind = "columns", height = 0.0, depth = 0.15, clumps = 1.0, flare = 0.0, warp = 0.0, inclination = 0.0, position_angle = "auto", center = "auto", near_side = "auto", bulge = "auto", galaxies = [ { inclination = 0.0, position_angle = "auto", center = "auto", near_side = "auto", bulge = "auto" } ], spiral = 1.0, axis_angle = "auto", tilt = "auto", stars = "auto", dust = "auto", opacity = 0.55, density = 0.75, border = 0.0, margin = 0.0 }
seed = 0
plane = 0
voxel_size = 0.0
file = ""
catalogue = ""
like = ""
depth = "layer"
slab = 0.0
unit = "auto"
limit = 12.0
zero_point = 4.0
along = ""
spread = 10.0
psf = 1.0
wings = { share = 0.0, px = 3.0, power = 2.5 }
spikes = { share = 0.0, vanes = 4, angle = 0.0, px = 40.0 }

[layer.look]
density = 1.0
reach = 0.0
pdf = { shape = "constant", rate = 3.0, sigma = 0.35, points = [] }
thickness = { map = "", derive = "none", keys = [ { color = [1.0, 1.0, 1.0], scale = 1.0, shape = "constant", rate = 3.0, sigma = 0.35, points = [] } ] }
noise = { frequency = 1.0, octaves = 4, lacunarity = 2.0, gain = 0.5, seed = 1, cull = 0.0, silhouette = 0.0, jitter = 0.0, alpha = 0.0, brightness = 0.0 }
alpha = { power = 1.0, threshold = 0.95, unpremultiply = false, gain = 1.0 }
vertical = { shape = "none", rate = 3.0, points = [], reach = 0.0, match = "auto" }
radius = { min = 0.0, max = 0.0, horizontal_scale = 1.0, vertical_scale = 1.0 }
grade = { gain = 1.0, tint = [1.0, 1.0, 1.0], saturation = 1.0, gamma = 1.0, black = 0.0 }

[layer.render]
falloff = "gaussian"
core = 0.5
sharpness = 4.5
blend = "over"
opacity = 1.0
hybrid = { from_deg = 30.0, to_deg = 80.0 }
absorb = [0.8, 1.0, 1.35]
lod = { max_px = 0.0, max_children = 4096, noise = 0.0, star_distance = 0.0 }
holdout = false
isolate = false
space = "linear"

)toml";

}  // namespace astrosplat::test
