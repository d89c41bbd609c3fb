"""Images are arrays of light, and files with the pixels of the command line's."""

from io import BytesIO

import numpy as np
import PIL.Image
import pytest

import tabray

SCENE = """look_at eye { pixeldim 16 12  position 0 2 9  target 0 0 0  angle 40  exposure 1 }
material red { ambient 0.2 0 0  diffuse 1 0 0 }
sphere ball { material red  center 0 0 0  radius 2 }
plane floor { material red  normal 0 1 0  point 0 -2 0 }
sun lamp { direction 1 2 3  emissivity 4 4 4 }
"""


def png_pixels(data):
    """Decode a PNG."""
    return np.asarray(PIL.Image.open(BytesIO(data)))


def test_an_image_is_linear_light_in_double_precision():
    image = tabray.parse(SCENE).render()
    assert image.array.shape == (12, 16, 3) and image.array.dtype == np.float64 and image.size == (16, 12)
    assert np.asarray(image) is image.array
    assert np.asarray(image, dtype=np.float32).dtype == np.float32
    brighter = tabray.parse(SCENE, set={"lamp.emissivity": [8, 8, 8], "red.ambient": [0.4, 0, 0]}).render()
    # Light adds up, which what is shown of it does not.
    assert np.allclose(brighter.array, 2 * image.array, rtol=1e-12) and image.array.max() > 1


def test_pngs_have_the_pixels_of_the_command_line(scenes, tmp_path):
    for name in ["torus", "sphere"]:
        image = tabray.load(scenes / "entities" / f"{name}.ray").render()
        image.save(tmp_path / "it.png")
        ours = png_pixels((tmp_path / "it.png").read_bytes())
        snapshot = scenes.parent / "snapshots" / "entities" / f"{name}.snap.png"
        assert np.array_equal(ours, png_pixels(snapshot.read_bytes())), name
        assert np.array_equal(png_pixels(image._repr_png_()), ours)


def test_formats_are_those_of_the_ending(tmp_path):
    image = tabray.parse(SCENE).render()
    image.save(tmp_path / "it.ppm")
    ppm = (tmp_path / "it.ppm").read_bytes()
    assert ppm.startswith(b"P6 16 12 255\n")
    assert np.array_equal(
        np.frombuffer(ppm[-16 * 12 * 3 :], np.uint8).reshape(12, 16, 3), png_pixels(image._repr_png_())
    )
    image.save(str(tmp_path / "it.pfm"))
    pfm = np.frombuffer((tmp_path / "it.pfm").read_bytes()[-16 * 12 * 12 :], np.float32)
    assert np.array_equal(pfm.reshape(12, 16, 3)[::-1], image.array.astype(np.float32))
    image.save(tmp_path / "it.exr")
    for name in ["it.gif", "it"]:
        with pytest.raises(ValueError, match="no known format"):
            image.save(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        image.save(tmp_path / "none" / "it.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["it.exr", "it.pfm", "it.ppm"]


def test_a_file_says_how_densely_it_is_printed(tmp_path):
    image = tabray.parse(SCENE).render()
    image.save(tmp_path / "plain.png")
    image.save(tmp_path / "dense.png", dpi=300)
    plain, dense = ((tmp_path / name).read_bytes() for name in ["plain.png", "dense.png"])
    assert b"pHYs" + 2 * (11811).to_bytes(4, "big") + b"\x01" in dense and b"pHYs" not in plain
    assert np.array_equal(png_pixels(plain), png_pixels(dense))
    image.save(tmp_path / "dense.exr", dpi=300)
    assert b"xDensity" in (tmp_path / "dense.exr").read_bytes()
    for name in ["it.ppm", "it.pfm"]:
        with pytest.raises(ValueError, match="end it in .png or .exr"):
            image.save(tmp_path / name, dpi=300)
    with pytest.raises(ValueError, match="a whole number from 1"):
        image.save(tmp_path / "it.png", dpi=0)


def test_what_shows_no_object_is_transparent(tmp_path):
    opaque = tabray.parse(SCENE).render(samples=16)
    image = tabray.parse(SCENE).render(samples=16, alpha=True)
    assert image.array.shape == (12, 16, 4) and opaque.array.shape == (12, 16, 3)
    light, alpha = image.array[..., :3], image.array[..., 3:]
    assert alpha.min() == 0 and alpha.max() == 1 and ((0 < alpha) & (alpha < 1)).any()
    # The scene has no background: it is black.
    assert np.allclose(light, opaque.array, atol=1e-3) and not light[alpha[..., 0] == 0].any()
    image.save(tmp_path / "it.png")
    assert (tmp_path / "it.png").read_bytes()[25] == 6, "RGBA"
    image.save(tmp_path / "it.exr")
    for name in ["it.ppm", "it.pfm"]:
        with pytest.raises(ValueError, match="cannot be transparent: end it in .png or .exr"):
            image.save(tmp_path / name)


def test_depth_objects_and_normals_are_those_of_the_rays():
    scene = tabray.parse(SCENE)
    image = scene.render(depth=True, objects=True, normals=True)
    assert image.depth.dtype == np.float64 and image.objects.dtype == np.int32
    assert set(np.unique(image.objects)) == {-1, 0, 1}
    assert np.array_equal(np.isinf(image.depth), image.objects == -1)
    lengths = np.linalg.norm(image.normals, axis=2)
    assert np.allclose(lengths, image.objects >= 0)
    plain = scene.render()
    assert plain.depth is None and plain.objects is None and plain.normals is None
    assert np.array_equal(plain.array, image.array)


def test_size_samples_and_method_are_chosen():
    scene = tabray.parse(SCENE)
    assert scene.render(width=8).size == (8, 6)
    assert scene.render(height=24).size == (32, 24)
    assert scene.render(width=5, height=7).array.shape == (7, 5, 3)
    assert not np.array_equal(scene.render(samples=4).array, scene.render().array)
    with pytest.raises(tabray.SceneError, match="the notes' rules of light do not know"):
        scene.render(method="classic")
    assert np.array_equal(scene.render(method="exact", threads=1).array, scene.render(threads=2).array)
    for wrong in [{"width": 0}, {"height": 10**6}, {"samples": 0}, {"method": "magic"}, {"threads": 0}]:
        with pytest.raises(ValueError):
            scene.render(**wrong)


def test_a_proof_has_a_mask_of_each_kind():
    scene = tabray.parse(SCENE)
    proof = scene.verify()
    masks = [proof.proven, proof.tie, proof.undecided, proof.contradicted]
    assert all(mask.shape == (12, 16) and mask.dtype == bool for mask in masks)
    assert np.array_equal(sum(mask.astype(int) for mask in masks), np.ones((12, 16)))
    assert proof.proven.mean() > 0.9 and not proof.contradicted.any()
