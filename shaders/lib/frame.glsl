// What every pass knows of the picture: the camera and the light.
uniform mat4 view;
uniform mat4 projection;
uniform vec3 eye;        // metres, stadium frame
uniform vec3 sun;        // unit vector towards the sun
uniform bool encode;     // the framebuffer takes sRGB bytes and doesn't encode by itself
