// Every ray against every triangle: a whole program for `sahara compare --runner`. Build your structure in `scene`, and query it in `query`.
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <vector>

struct Vec { float x, y, z; };
struct Ray { Vec origin; float t_min; Vec direction; float t_max; };
struct Hit { float t; uint32_t prim; };
struct Set { std::string head; std::vector<Ray> rays; std::vector<Hit> hits; };
struct Triangle { Vec corner, edge1, edge2; };

Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> const T *at(const std::string &bytes, size_t i) { return (const T *)(bytes.data() + i); }
double since(clock_t begin) { return double(clock() - begin) / CLOCKS_PER_SEC; } // processor time: one thread is not disturbed by others
std::string file(const char *path) { std::ifstream in(path, std::ios::binary); return {std::istreambuf_iterator<char>(in), {}}; }

Hit query(const std::vector<Triangle> &triangles, const Ray &ray, bool any) {
    Hit hit{ray.t_max, 0xffffffff};
    for (uint32_t i = 0; i < triangles.size() && !(any && hit.prim != 0xffffffff); i++) { // Möller, Trumbore, 1997
        const Triangle &of = triangles[i];
        Vec p = cross(ray.direction, of.edge2), s = ray.origin - of.corner, q = cross(s, of.edge1);
        float det = dot(of.edge1, p), u = dot(s, p) / det, v = dot(ray.direction, q) / det, t = dot(of.edge2, q) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t >= ray.t_min && t < hit.t) hit = {t, i};
    }
    return hit;
}

int main() {
    std::vector<Triangle> triangles;
    std::map<int, Set> sets;
    char path[4096];
    for (std::string line; std::getline(std::cin, line); fflush(stdout)) {
        int id = 0;
        if (sscanf(line.c_str(), "sahara %d", &id) == 1) {
            puts("runner 1 closest any");
        } else if (sscanf(line.c_str(), "scene %4095[^\n]", path) == 1) {
            std::string ply = file(path);
            size_t n = std::stoul(ply.substr(ply.find("vertex ") + 7)), m = std::stoul(ply.substr(ply.find("face ") + 5));
            const Vec *vertices = at<Vec>(ply, ply.find("end_header\n") + 11);
            clock_t begin = clock();
            for (size_t i = 0; i < m; i++) {
                const uint32_t *v = at<uint32_t>(ply, (const char *)(vertices + n) - ply.data() + 13 * i + 1);
                triangles.push_back({vertices[v[0]], vertices[v[1]] - vertices[v[0]], vertices[v[2]] - vertices[v[0]]});
            }
            printf("built %.9f %zu\n", since(begin), sizeof(Triangle) * m);
        } else if (sscanf(line.c_str(), "rays %d %4095[^\n]", &id, path) == 2) {
            std::string rays = file(path);
            const Ray *first = at<Ray>(rays, (72 + *at<uint32_t>(rays, 64) + *at<uint32_t>(rays, 68) + 31) / 32 * 32);
            sets[id] = {"SAHAHITS" + rays.substr(8, 24), {first, first + *at<uint64_t>(rays, 16)}, {}};
            printf("loaded %zu\n", sets[id].rays.size());
        } else if (sscanf(line.c_str(), "pass %d", &id) == 1) {
            Set &set = sets[id];
            set.hits.resize(set.rays.size());
            clock_t begin = clock();
            for (size_t i = 0; i < set.rays.size(); i++) set.hits[i] = query(triangles, set.rays[i], set.head[12] == 1);
            printf("passed %.9f\n", since(begin));
        } else if (sscanf(line.c_str(), "hits %d %4095[^\n]", &id, path) == 2) {
            std::ofstream(path, std::ios::binary).write(sets[id].head.data(), 32).write((const char *)sets[id].hits.data(), 8 * sets[id].hits.size());
            printf("written %zu\n", sets[id].hits.size());
        } else {
            puts("error this request is not known");
        }
    }
}
