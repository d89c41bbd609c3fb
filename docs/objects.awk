# Writes the scene of many objects that src/measure/bench/scenes.rs makes: `name` is sphere, triangle or mesh, and `count` the
# number of objects. A mesh is that of the triangles, in the file `ply`.
function part(x) { return x - int(x) }
function at(ring, step,    y, angle, radius) {
    y = 6.25 * ring / rings; angle = 6.283185307179586 * (step % around) / around; radius = 2 + sin(y)
    return sprintf("%.17g %.17g %.17g", 4 + radius * cos(angle), y, -4 + radius * sin(angle))
}
BEGIN {
    print "camera eye { pixeldim 640 480 worlddim 8 6 viewpoint 4 3 7 }"
    print "material white { ambient 1 1 1 diffuse 4 4 4 }"
    print "light left { location 2 4 0 emissivity 3 3 3 }"
    print "light right { location 6 4 0 emissivity 3 3 3 }"
    if (name == "sphere") {
        for (i = 0; i < count; i++)
            printf "sphere s%d { material white center %.17g %.17g %.17g radius %.17g }\n", i, \
                8 * part((i + 1) * 0.8191725133961645), 6 * part((i + 1) * 0.6710436067037893), \
                -8 * part((i + 1) * 0.5497004779019702) - 1, 1.5 / sqrt(count)
        exit
    }
    rings = int(sqrt(count / 2)); around = int(count / 2 / rings)
    if (name == "mesh") {
        print "mesh all { material white file \"scene.ply\" }"
        print "ply\nformat ascii 1.0\nelement vertex " (rings + 1) * around >ply
        print "property double x\nproperty double y\nproperty double z" >ply
        print "element face " 2 * rings * around "\nproperty list uchar int vertex_indices\nend_header" >ply
        for (i = 0; i < (rings + 1) * around; i++) print at(int(i / around), i % around) >ply
        for (i = 0; i < rings * around; i++) {
            a = i; b = i - i % around + (i + 1) % around
            print "3 " a, b, a + around "\n3 " b, b + around, a + around >ply
        }
        exit
    }
    for (i = 0; i < rings * around; i++) {
        ring = int(i / around); step = i % around
        a = at(ring, step); b = at(ring, step + 1); c = at(ring + 1, step); d = at(ring + 1, step + 1)
        printf "triangle low%d { material white vertex1 %s vertex2 %s vertex3 %s }\n", i, a, b, c
        printf "triangle high%d { material white vertex1 %s vertex2 %s vertex3 %s }\n", i, b, d, c
    }
}
