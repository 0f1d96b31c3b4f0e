// What child_tables.glsl and circle.glsl read.
layout(std430, binding = 8) readonly buffer ChildRadii { float child_radius[]; };
layout(std430, binding = 9) readonly buffer ChildFading { float child_fading[]; };
layout(std430, binding = 10) readonly buffer ChildSteady { double child_steady[]; };
uniform double circle_numbers[14];
