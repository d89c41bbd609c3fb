# Simulates an image in parts on many nodes, from measured times. Prints a table in Markdown, and draws a chart.
#
#     awk -v chart=docs/charts/scale.svg -f docs/scale.awk
#
# A task is taken by the first free node. Times are in seconds.
BEGIN {
    work = 1000 * 3600      # of one node, for the whole image
    spread = 0.25           # standard deviation of the logarithm of a part's time: of marbles
    slow = 0.02             # the share of nodes that take twice as long: assumed
    lives = 30 * 86400      # the mean time between the failures of a node: assumed
    noticed = 300           # until a dead node is noticed and its task is queued again: Slurm's default
    away = 1800             # until it is back: assumed
    merging = 5.1; each = 2.2e-5    # of 3.6 GB, and of each part: measured
    start["a ball"] = 0.03; start["10^6 spheres"] = 5.1     # CPU time of a part beside its rays: measured
    print "| scene | nodes | parts per node | 1 | 2 | 4 | 8 | 16 | 32 | 64 |"
    print "|---|---:|---|---:|---:|---:|---:|---:|---:|---:|"
    count = split("a ball,10^6 spheres", scenes, ",")
    for (s = 1; s <= count; s++)
        for (nodes = 10; nodes <= 1000; nodes *= 10) {
            printf "| %s | %d | efficiency, %% |", scenes[s], nodes
            for (p = 0; p < 7; p++) {
                rounds = nodes == 1000 ? 3 : 10
                total = 0
                # The same draws for both scenes.
                for (r = 0; r < rounds; r++) {
                    seed = 7919 * (10 * p + r + 1)
                    total += image(nodes, nodes * 2 ^ p, start[scenes[s]])
                }
                efficiency[s, nodes, p] = 100 * work / nodes / (total / rounds)
                printf " %.0f |", efficiency[s, nodes, p]
            }
            print ""
        }
    print "\n| a film of 10^5 frames of 36 s | hours | efficiency, % |\n|---|---:|---:|"
    for (nodes = 10; nodes <= 1000; nodes *= 10) {
        seed = 7919
        time = image(nodes, 100000, start["a ball"]) - merging - 100000 * each
        printf "| %d nodes | %.2f | %.0f |\n", nodes, time / 3600, 100 * work / nodes / time
    }
    if (chart) draw()
}

function uniform() { seed = seed * 16807 % 2147483647; return seed / 2147483647 }
function normal() { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()) }

# Returns the time of an image, merging included.
function image(nodes, parts, overhead,    node, at, left, took, last, dies, again) {
    size = 0
    for (node = 0; node < nodes; node++) {
        pace[node] = uniform() < slow ? 2 : 1
        life[node] = -lives * log(uniform())
        push(0, node)
    }
    left = parts; again = 0; last = 0
    while (left > 0 || again > 0) {
        pop(); at = top; node = who
        # A task that was lost is there again only once the failure is noticed.
        if (left > 0) left--
        else { again--; if (back[again] > at) at = back[again] }
        took = pace[node] * (overhead + work / parts * exp(spread * normal() - spread * spread / 2))
        if (at + took > life[node]) {
            dies = life[node] > at ? life[node] : at
            back[again++] = dies + noticed
            life[node] = dies + away - lives * log(uniform())
            push(dies + away, node)
        } else {
            push(at + took, node)
            if (at + took > last) last = at + took
        }
    }
    return last + merging + parts * each
}

# The nodes by when they are free: a heap.
function push(at, node,    i, up) {
    i = ++size
    while (i > 1 && heap[up = int(i / 2)] > at) { heap[i] = heap[up]; of[i] = of[up]; i = up }
    heap[i] = at; of[i] = node
}
function pop(    i, down, at, node) {
    top = heap[1]; who = of[1]; at = heap[size]; node = of[size--]
    for (i = 1; (down = 2 * i) <= size; i = down) {
        if (down < size && heap[down + 1] < heap[down]) down++
        if (heap[down] >= at) break
        heap[i] = heap[down]; of[i] = of[down]
    }
    heap[i] = at; of[i] = node
}

function draw(    s, n, p, nodes, line) {
    split("#1b6ca8,#c8553d", colour, ",")
    split("10:none,100:6 4,1000:2 3", dash, ",")
    # The legend stands below, in two columns, so that a phone shows the text large enough to read.
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"480\" height=\"487\" viewBox=\"0 0 480 487\" font-family=\"sans-serif\" font-size=\"14\">" >chart
    print "<rect width=\"480\" height=\"487\" fill=\"white\"/>" >chart
    for (p = 0; p <= 100; p += 20) {
        printf "<path d=\"M60 %d H450\" stroke=\"#ddd\"/><text x=\"54\" y=\"%d\" text-anchor=\"end\">%d</text>\n", 350 - 3 * p, 355 - 3 * p, p >chart
    }
    for (p = 0; p < 7; p++) printf "<text x=\"%d\" y=\"370\" text-anchor=\"middle\">%d</text>\n", 60 + 65 * p, 2 ^ p >chart
    print "<text x=\"255\" y=\"392\" text-anchor=\"middle\">parts per node</text><text x=\"10\" y=\"30\">efficiency, %</text>" >chart
    for (s = 1; s <= count; s++)
        for (n = 1; n <= 3; n++) {
            nodes = 10 ^ n
            line = "M"
            for (p = 0; p < 7; p++) line = line sprintf("%s%d %.1f", p ? " L" : "", 60 + 65 * p, 350 - 3 * efficiency[s, nodes, p])
            split(dash[n], style, ":")
            printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\" stroke-dasharray=\"%s\"/>\n", line, colour[s], style[2] >chart
            x = s == 1 ? 20 : 220; y = 393 + 24 * n
            printf "<path d=\"M%d %d h40\" stroke=\"%s\" stroke-width=\"2\" stroke-dasharray=\"%s\"/><text x=\"%d\" y=\"%d\">%s, %d nodes</text>\n", x, y, colour[s], style[2], x + 48, y + 5, scenes[s], nodes >chart
        }
    print "</svg>" >chart
}
