// light/image_space.cl: glass bent at one surface or at two (vitrail/light/glass.h, One and Two).
#include "lib/fresnel.cl"
#include "lib/march.cl"
#include "lib/range.cl"
#include "lib/view.cl"
#pragma OPENCL FP_CONTRACT OFF

// The mesh as it is seen, and where rays go; positions: where each ray goes on from, world, or null.
#define IMAGE_PARAMETERS                                                                                                     \
    const vitrail_CameraDesc camera, global const float *positions, global const uint *indices, global const float *normals, \
        global const uint *triangleMaterial, global const uint *nearest, global const vitrail_MaterialDesc *materials,       \
        global vitrail_RayEnd *rays, global float4 *from
#define IMAGE_SEEN \
    { &camera, positions, indices, normals, triangleMaterial, materials }

typedef struct {
    const vitrail_CameraDesc* camera;
    global const float* positions;
    global const uint* indices;
    global const float* normals;
    global const uint* triangleMaterial;
    global const vitrail_MaterialDesc* materials;
} Seen;

// A ray after its first surface, in world space.
typedef struct {
    float3 incident, direction, position;
    vitrail_MaterialDesc material;
    float3 through;
    uint fate, events;
    bool inside;  // on its way through glass
} Path;

// Where a pixel's ray meets the plane of a triangle that it sees.
static inline bool image_point(const Seen* seen, uint triangle, float3 o, float3 d, float3* position, float3* normal, float3* flat) {
    vitrail_GridDesc world;
    world.origin = (float4)(0.0f);
    world.extent = (float4)(1.0f);
    return march_first_hit(&world, seen->positions, seen->indices, seen->normals, triangle, o, d, position, normal, flat);
}

static inline Path image_first(const Seen* seen, uint triangle, size_t pixel) {
    Path path;
    camera_ray(seen->camera, (uint)(pixel % seen->camera->width), (uint)(pixel / seen->camera->width), &path.position, &path.direction);
    path.incident = path.direction;
    path.through = (float3)(1.0f);
    path.fate = VITRAIL_RAY_MISSED;
    path.events = 0u;
    path.inside = false;
    path.material = seen->materials[0];
    float3 position, normal, flat;
    if (triangle == NO_TRIANGLE || !image_point(seen, triangle, path.position, path.direction, &position, &normal, &flat)) return path;
    path.material = seen->materials[seen->triangleMaterial ? seen->triangleMaterial[triangle] : 0u];
    path.position = position;
    path.through = xyz(path.material.colour);
    if (path.material.colour.w <= 0.5f) {
        path.fate = VITRAIL_RAY_OPAQUE;
        path.direction = dot(path.direction, normal) > 0.0f ? -normal : normal;
        return path;
    }
    path.fate = VITRAIL_RAY_LEFT;
    const bool within = dot(path.direction, flat) > 0.0f;  // the camera is
    const float index = path.material.absorption.w;
    const bool crossed = optics_cross(&path.direction, optics_facing(path.direction, normal, flat), flat, within ? index : 1.0f / index);
    path.inside = crossed != within;
    path.events = 1u;
    return path;
}

// Out of the glass by a second surface, `length` further.
static inline void image_second(Path* path, float3 normal, float3 flat, float length) {
    if (!(dot(path->direction, flat) > 0.0f)) return;
    path->position += path->direction * length;
    path->through *= optics_absorb(path->material.absorption, length);
    optics_cross(&path->direction, optics_facing(path->direction, normal, flat), flat, path->material.absorption.w);
    ++path->events;
}

static inline void image_end(const Path* path, size_t pixel, global vitrail_RayEnd* rays, global float4* from) {
    const float3 d = path->direction, t = path->through;
    const vitrail_RayEnd out = {{d.x, d.y, d.z}, path->fate, {t.x, t.y, t.z}, path->events};
    rays[pixel] = out;
    if (from) from[pixel] = (float4)(path->position, 0.0f);
}

kernel void one_ends(IMAGE_PARAMETERS, ulong count, uint perItem) {
    const Seen seen = IMAGE_SEEN;
    FOR_RANGE(pixel, count, perItem) {
        const Path path = image_first(&seen, nearest[pixel], pixel);
        image_end(&path, pixel, rays, from);
    }
}

#define TWO_THIN 3  // cells from the surface within which the glass begins, or is thinner than one

// The share of the cells around a point that is inside, by their distance to it.
static inline float two_inside(const View* solid, float3 p) {
    const float3 low = floor(p - 0.5f), part = p - 0.5f - low;
    const int x = (int)low.x, y = (int)low.y, z = (int)low.z;
    float share = 0.0f;
    for (int k = 0; k < 8; ++k) {
        const int i = k & 1, j = (k >> 1) & 1, l = k >> 2;
        if (view_occupied(solid, x + i, y + j, z + l))
            share += (i ? part.x : 1.0f - part.x) * (j ? part.y : 1.0f - part.y) * (l ? part.z : 1.0f - part.z);
    }
    return share;
}

// Cells along the incident ray until the first that is not inside; `p`: on the surface.
static inline float two_thickness(const View* solid, float3 p, float3 d) {
    const float3 a = fabs(d);
    const float step = 1.0f / fmax(a.x, fmax(a.y, a.z));
    const int most = (int)(solid->grid->size.x + solid->grid->size.y + solid->grid->size.z);
    bool inside = false;
    for (int k = 0; k < most; ++k) {
        const float3 at = p + d * (step * ((float)k + 0.5f));
        const bool now = view_occupied(solid, view_cell(at.x), view_cell(at.y), view_cell(at.z));
        if (!now && (inside || k == TWO_THIN)) {
            if (!inside) return 0.5f * step;
            const float before = two_inside(solid, at - d * step), after = two_inside(solid, at);
            return ((float)k - 0.5f + (before > 0.5f && after < 0.5f ? (before - 0.5f) / (before - after) : 0.5f)) * step;
        }
        inside = inside || now;
    }
    return 0.0f;
}

// The normal of the surface voxel of a column nearest to slice z by which a ray can leave.
static inline bool two_column(const View* surface, int x, int y, int z, float3 d, float3* normal) {
    const int most = (int)surface->grid->size.z;
    for (int k = 0; k < most; ++k)
        for (int side = 0; side < (k == 0 ? 1 : 2); ++side) {
            const int at = side == 0 ? z + k : z - k;
            if (!view_occupied(surface, x, y, at)) continue;
            *normal = view_normal(surface, x, y, at);
            if (dot(*normal, d) > 0.0f) return true;
        }
    return false;
}

// Those of the four columns around p, by their distance.
static inline bool two_normal(const View* surface, float3 p, float3 d, float3* normal) {
    const float2 low = floor(p.xy - 0.5f), part = p.xy - 0.5f - low;
    float3 sum = (float3)(0.0f);
    for (int k = 0; k < 4; ++k) {
        const int i = k & 1, j = k >> 1;
        float3 n;
        if (two_column(surface, (int)low.x + i, (int)low.y + j, view_cell(p.z), d, &n))
            sum += n * ((i ? part.x : 1.0f - part.x) * (j ? part.y : 1.0f - part.y));
    }
    const float length = sqrt(dot(sum, sum));
    *normal = sum / length;
    return length > 0.0f;
}

kernel void two_voxels_ends(IMAGE_PARAMETERS, const vitrail_GridDesc grid, global const uint* words, global const uint2* bricks,
                            global const uint* rank, global const uint* voxelNormals, global const uint* solidWords,
                            global const uint2* solidBricks, ulong count, uint perItem) {
    const Seen seen = IMAGE_SEEN;
    const View surface = {&grid, words, bricks, rank, voxelNormals}, solid = {&grid, solidWords, solidBricks, 0, 0};
    FOR_RANGE(pixel, count, perItem) {
        Path path = image_first(&seen, nearest[pixel], pixel);
        if (path.inside) {
            const float3 p = view_voxel(&grid, path.position), d = view_direction(&grid, path.direction);
            const float thickness = two_thickness(&solid, p, view_direction(&grid, path.incident));
            float3 normal;
            if (two_normal(&surface, p + d * thickness, d, &normal)) {
                normal = view_world_direction(&grid, normal);
                image_second(&path, normal, normal, thickness * view_edge(&grid));
            }
        }
        image_end(&path, pixel, rays, from);
    }
}

// The pixel that sees a point.
static inline bool image_project(const vitrail_CameraDesc* camera, float3 p, size_t* pixel) {
    const float3 v = p - xyz(camera->eye);
    const float depth = camera->eye.w > 0.5f ? 1.0f : dot(v, xyz(camera->forward));
    if (!(depth > 0.0f)) return false;
    const float x = (dot(v, xyz(camera->right)) / (depth * camera->right.w) * 0.5f + 0.5f) * (float)camera->width;
    const float y = (0.5f - dot(v, xyz(camera->up)) / (depth * camera->up.w) * 0.5f) * (float)camera->height;
    if (!(x >= 0.0f && x < (float)camera->width && y >= 0.0f && y < (float)camera->height)) return false;
    *pixel = (size_t)(uint)y * camera->width + (uint)x;
    return true;
}

// `back`: the nearest triangle that faces away, of each pixel.
kernel void two_image_ends(IMAGE_PARAMETERS, global const uint* back, ulong count, uint perItem) {
    const Seen seen = IMAGE_SEEN;
    FOR_RANGE(pixel, count, perItem) {
        Path path = image_first(&seen, nearest[pixel], pixel);
        float3 o, d, behind, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        if (path.inside && back[pixel] != NO_TRIANGLE && image_point(&seen, back[pixel], o, d, &behind, &normal, &flat)) {
            const float3 along = behind - path.position;
            const float thickness = sqrt(dot(along, along));
            size_t there;
            if (image_project(&camera, path.position + path.direction * thickness, &there) && back[there] != NO_TRIANGLE) {
                camera_ray(&camera, (uint)(there % camera.width), (uint)(there / camera.width), &o, &d);
                if (image_point(&seen, back[there], o, d, &behind, &normal, &flat)) image_second(&path, normal, flat, thickness);
            }
        }
        image_end(&path, pixel, rays, from);
    }
}
