# Translates a scene of docs/objects.awk, of spheres or of triangles, for POV-Ray. Objects are parts of one, a union or a
# mesh, if `whole` names that: else each has its texture. `course.inc` is in the folder of the peers' scenes.
BEGIN {
    print "#version 3.7;\n#include \"course.inc\"\nCourseCamera(<4,3,7>, 8, 6)"
    print "CourseLight(<2,4,0>, <3,3,3>)\nCourseLight(<6,4,0>, <3,3,3>)"
    print "#declare White = texture { pigment { rgb 0.4 } finish { ambient 0.25 diffuse 1 } }"
    if (whole) print whole " {"
    look = whole ? "" : "texture { White } "
}
/^sphere/ { printf "sphere { <%s,%s,%s>, %s %s}\n", $7, $8, $9, $11, look }
/^triangle/ {
    printf "triangle { <%s,%s,%s>, <%s,%s,%s>, <%s,%s,%s> %s}\n", $7, $8, $9, $11, $12, $13, $15, $16, $17, look
}
END { if (whole) print "texture { White } }" }
