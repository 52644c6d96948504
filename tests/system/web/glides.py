"""Scripts and shapes for tests of the motion between drawings."""

CENTRE = """(canvas) => {
    const { width, height } = canvas, data = canvas.getContext('2d').getImageData(0, 0, width, height).data;
    let [n, x, y] = [0, 0, 0];
    for (let i = 0; i < width * height; i++)
        if (data[4 * i] > 200 && data[4 * i + 1] < 80) { n++; x += i % width; y += Math.floor(i / width); }
    return [x / n - width / 2, height / 2 - y / n];
}"""
"""The middle of all that is red, in pixels from the middle of the canvas."""
WAIT_FOR_GLIDES = """(wanted) => new Promise((done, fail) => {
    setTimeout(fail, 60_000, 'shapes jump from drawing to drawing');
    const [ask, canvas] = [window.fetch, document.querySelector('canvas')];
    let [drawings, last] = [0, ''], places = {};
    window.fetch = async (...all) => {
        const answer = await ask(...all);
        if (all[0].includes('/drawing') && answer.status === 200) drawings++;
        return answer;
    };
    const look = () => {
        const place = (CENTRE)(canvas).join();
        if (place !== last) places[drawings] = (places[drawings] || 0) + 1;
        last = place;
        if (Object.values(places).filter((n) => n > 1).length >= wanted) done();
        else requestAnimationFrame(look);
    };
    look();
})""".replace("CENTRE", CENTRE)
"""Returns after as many drawings as wanted were seen at two places or more before the next drawing came."""
GLIDES = """async (shapes) => {
    const own = performance.getEntriesByType('resource').find((each) => each.name.includes('canvas.js')).name;
    const { paired, between } = await import(own);
    const made = paired(...shapes).map((pair) => between(pair, 0.5));
    return JSON.parse(JSON.stringify(made), (_, value) => typeof value === 'number' ? +value.toFixed(3) : value);
}"""
"""Returns the shapes half-way between two drawings."""

PICTURE_TIMES = """async () => {
    const own = performance.getEntriesByType('resource').find((each) => each.name.includes('canvas.js')).name;
    const { pictureTime } = await import(own);
    const dear = [20, 4, 5, 6, 90];
    return [pictureTime(dear, false), pictureTime(dear, true), pictureTime([1, 1], true), pictureTime([], true),
            pictureTime([900], true)];
}"""
"""Returns times between pictures: with time to spare, without, where pictures are cheap, unknown, very dear."""

BEFORE = [
    {"k": "circle", "of": "a", "x": 0, "y": 0, "r": 1},
    {"k": "line", "of": "a", "p": [[0, 0], [-1, 0.001]]},
    {"k": "line", "of": "b", "p": [[0, 0], [1, 0]]},
    {"k": "ellipse", "of": "a", "x": 0, "y": 0, "a": 2, "b": 1, "t": 1.5},
    {"k": "circle", "of": "gone", "x": 9, "y": 9, "r": 1},
]
AFTER = [
    {"k": "circle", "of": "a", "x": 2, "y": 4, "r": 1, "fill": "red"},
    {"k": "line", "of": "a", "p": [[2, 0], [2, -1]]},
    {"k": "line", "of": "b", "p": [[0, 2], [3, 0]]},
    {"k": "ellipse", "of": "a", "x": 0, "y": 0, "a": 2, "b": 1, "t": -1.5},
    {"k": "circle", "of": "new", "x": 5, "y": 5, "r": 1},
    {"k": "line", "of": "new", "p": []},
]
HALF_WAY = [
    {"k": "circle", "of": "a", "x": 1, "y": 2, "r": 1, "fill": "red"},
    {"k": "line", "of": "a", "p": [[1, 0], [0.293, -0.707]]},
    {"k": "line", "of": "b", "p": [[0, 1], [2, 0]]},
    {"k": "ellipse", "of": "a", "x": 0, "y": 0, "a": 2, "b": 1, "t": 1.571},
    {"k": "circle", "of": "new", "x": 5, "y": 5, "r": 1},
    {"k": "line", "of": "new", "p": []},
]
"""A line that keeps its length turns, the short way, and so do ellipses; a new shape is where it is."""
