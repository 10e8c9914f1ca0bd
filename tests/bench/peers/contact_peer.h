/* What a peer of the contact bench offers: a shape made once, and the distance of two placed shapes. Kinds: 0 sphere
 * (size[0] radius), 1 box (size: half extents), 2 cylinder along Y (size[0] radius, size[1] half height), 3 hull of points,
 * 4 mesh of triangles. A pose is a rotation by columns, then the place. Lengths in m. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

const char *peer_name(void);
/* Null: this peer has no such shape. */
void *peer_shape(int kind, const double *size, const double *points, int point_count,
                 const unsigned *indices, int triangle_count);
/* The distance; normal[3] from b to a. Negative: it found none. */
double peer_distance(void *a, const double *pose_a, void *b, const double *pose_b, double *normal);

#ifdef __cplusplus
}
#endif
