# Draws a chart with logarithmic axes as an SVG, from lines of a series, an x and a y; blanks in names are written as `_`.
#
#     awk -v across="objects" -v up="frame, ms" -f docs/loglog.awk TABLE >CHART
#
# Series are drawn in the order in which they come. Those whose names begin alike up to a comma have one colour.
function place(x) { return 60 + 390 * (log(x) / log(10) - least) / (most - least) }
function height(y) { return 350 - 320 * (log(y) / log(10) - low) / (high - low) }
function floor(x) { return int(x) - (x < int(x)) }
function power(n) { return n < 0 || n > 4 ? "10^" n : 10 ^ n }
{
    if (!($1 in count)) order[++series] = $1
    number = ++count[$1]; xs[$1, number] = $2; ys[$1, number] = $3
    x = log($2) / log(10); y = log($3) / log(10)
    if (NR == 1 || x < least) least = x
    if (NR == 1 || x > most) most = x
    if (NR == 1 || y < low) low = y
    if (NR == 1 || y > high) high = y
}
END {
    split("#1b6ca8,#c8553d,#4a7c3a,#8a5a9e", colours, ",")
    split("none,6 4,2 3,8 3 2 3", dashes, ",")
    least = floor(least); most = -floor(-most); low = floor(low); high = -floor(-high)
    # The legend stands below, in two columns, so that a phone shows the text large enough to read.
    tall = 415 + 24 * int((series + 1) / 2)
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"480\" height=\"%d\" viewBox=\"0 0 480 %d\" font-family=\"sans-serif\" font-size=\"14\">\n", tall, tall
    printf "<rect width=\"480\" height=\"%d\" fill=\"white\"/>\n", tall
    for (n = low; n <= high; n++)
        printf "<path d=\"M60 %.1f H450\" stroke=\"#ddd\"/><text x=\"54\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", height(10 ^ n), height(10 ^ n) + 5, power(n)
    for (n = least; n <= most; n++)
        printf "<path d=\"M%.1f 350 V30\" stroke=\"#eee\"/><text x=\"%.1f\" y=\"370\" text-anchor=\"middle\">%s</text>\n", place(10 ^ n), place(10 ^ n), power(n)
    printf "<text x=\"255\" y=\"392\" text-anchor=\"middle\">%s</text><text x=\"10\" y=\"20\">%s</text>\n", across, up
    for (s = 1; s <= series; s++) {
        name = order[s]; family = name; sub(/,.*/, "", family)
        if (!(family in colour)) colour[family] = colours[++families]
        dash = dashes[++members[family]]
        line = ""
        for (n = 1; n <= count[name]; n++) line = line sprintf("%s%.1f %.1f", n > 1 ? " L" : "M", place(xs[name, n]), height(ys[name, n]))
        printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\" stroke-dasharray=\"%s\"/>\n", line, colour[family], dash
        gsub(/_/, " ", name)
        x = s % 2 ? 20 : 250; y = 393 + 24 * int((s + 1) / 2)
        printf "<path d=\"M%d %d h40\" stroke=\"%s\" stroke-width=\"2\" stroke-dasharray=\"%s\"/><text x=\"%d\" y=\"%d\">%s</text>\n", x, y, colour[family], dash, x + 48, y + 5, name
    }
    print "</svg>"
}
