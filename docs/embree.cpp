// The built-in scenes of many objects (src/measure/bench/scenes.rs) by Embree: single rays in single precision on one
// thread, without shading. Prints the milliseconds of CPU time of a frame and of building on one thread, the milliseconds
// of building on all threads, and the number of rays.
//
//     embree spheres|triangles|meshes EXPONENT

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <embree3/rtcore.h>
#include <initializer_list>
#include <ctime>

struct Vector {
    double x, y, z;
};

static Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector unit(Vector a) {
    double inverse = 1 / std::sqrt(dot(a, a));
    return {a.x * inverse, a.y * inverse, a.z * inverse};
}

static double now(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// As many as `count` spheres or triangles.
static RTCGeometry geometry(RTCDevice device, bool spheres, size_t count) {
    RTCGeometry geometry;
    if (spheres) {
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto at = (float *)rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count);
        double radius = 1.5 / std::sqrt(double(count)), whole;
        for (size_t index = 0; index < count; index++) {
            double number = double(index + 1);
            *at++ = float(8 * std::modf(number * 0.8191725133961645, &whole));
            *at++ = float(6 * std::modf(number * 0.6710436067037893, &whole));
            *at++ = float(-8 * std::modf(number * 0.5497004779019702, &whole) - 1);
            *at++ = float(radius);
        }
    } else {
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        size_t rings = size_t(std::sqrt(double(count / 2))), around = count / 2 / rings;
        auto at = (float *)rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), (rings + 1) * around);
        for (size_t ring = 0; ring <= rings; ring++) {
            for (size_t step = 0; step < around; step++) {
                double y = 6.25 * double(ring) / double(rings), angle = 2 * M_PI * double(step) / double(around);
                double radius = 2 + std::sin(y);
                *at++ = float(4 + radius * std::cos(angle));
                *at++ = float(y);
                *at++ = float(-4 + radius * std::sin(angle));
            }
        }
        auto corner = (unsigned *)rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), 2 * rings * around);
        for (size_t ring = 0; ring < rings; ring++) {
            for (size_t step = 0; step < around; step++) {
                auto at = [&](size_t ring, size_t step) { return unsigned(ring * around + step % around); };
                unsigned a = at(ring, step), b = at(ring, step + 1), c = at(ring + 1, step), d = at(ring + 1, step + 1);
                for (unsigned vertex : {a, b, c, b, d, c}) *corner++ = vertex;
            }
        }
    }
    rtcCommitGeometry(geometry);
    return geometry;
}

static RTCRay ray(Vector from, Vector dir, double near, double far) {
    RTCRay ray;
    std::memset(&ray, 0, sizeof ray);
    ray.org_x = float(from.x), ray.org_y = float(from.y), ray.org_z = float(from.z);
    ray.dir_x = float(dir.x), ray.dir_y = float(dir.y), ray.dir_z = float(dir.z);
    ray.tnear = float(near), ray.tfar = float(far), ray.mask = -1u;
    return ray;
}

// Traces a frame; the number of its rays.
static size_t frame(RTCScene scene, bool two_sided) {
    const Vector eye = {4, 3, 7}, lights[] = {{2, 4, 0}, {6, 4, 0}};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    size_t rays = 0;
    volatile size_t blocked = 0;
    for (int y = 0; y < 480; y++) {
        for (int x = 0; x < 640; x++) {
            Vector dir = unit(Vector{(x + 0.5) / 640 * 8, (y + 0.5) / 480 * 6, 0} - eye);
            RTCRayHit hit;
            hit.ray = ray(eye, dir, 0, INFINITY);
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &hit);
            rays++;
            if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            // Triangles are lit on one side, as they are there, and open meshes on both.
            Vector normal = unit({hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z});
            if (two_sided && dot(normal, dir) > 0) normal = {-normal.x, -normal.y, -normal.z};
            double t = hit.ray.tfar;
            Vector at = {eye.x + t * dir.x, eye.y + t * dir.y, eye.z + t * dir.z};
            for (Vector light : lights) {
                Vector between = light - at, toward = unit(between);
                if (dot(toward, normal) <= 0) continue;
                RTCRay shadow = ray(at, toward, 1e-4, std::sqrt(dot(between, between)));
                rtcOccluded1(scene, &context, &shadow);
                rays++;
                if (shadow.tfar < 0) blocked = blocked + 1;
            }
        }
    }
    return rays;
}

int main(int, char **arguments) {
    bool spheres = !std::strcmp(arguments[1], "spheres"), meshes = !std::strcmp(arguments[1], "meshes");
    size_t count = size_t(std::lround(std::pow(10, std::atoi(arguments[2]))));
    double building[2];
    for (int all = 0; all < 2; all++) {
        RTCDevice device = rtcNewDevice(all ? "" : "threads=1");
        clockid_t clock = all ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID;
        building[all] = INFINITY;
        // The first scene starts the threads.
        for (int run = 0; run < 3; run++) {
            RTCScene scene = rtcNewScene(device);
            RTCGeometry of = geometry(device, spheres, count);
            rtcAttachGeometry(scene, of);
            double start = now(clock);
            rtcCommitScene(scene);
            building[all] = std::fmin(building[all], now(clock) - start);
            if (all && run == 2) {
                double least = INFINITY, begin = now(CLOCK_THREAD_CPUTIME_ID);
                size_t rays = 0;
                for (int run = 0; run < 3 || now(CLOCK_THREAD_CPUTIME_ID) - begin < 0.5; run++) {
                    start = now(CLOCK_THREAD_CPUTIME_ID);
                    rays = frame(scene, meshes);
                    least = std::fmin(least, now(CLOCK_THREAD_CPUTIME_ID) - start);
                }
                std::printf("%.2f %.2f %.2f %zu\n", 1e3 * least, 1e3 * building[0], 1e3 * building[1], rays);
            }
            rtcReleaseGeometry(of);
            rtcReleaseScene(scene);
        }
        rtcReleaseDevice(device);
    }
}
