// The pose source that the program was built for.
#ifdef BAKED
#include "lib/pose_baked.glsl"
#else
#include "lib/pose_streams.glsl"
#endif
