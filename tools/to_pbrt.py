# A scene of `make corpus` for pbrt-v4:
#
#   python3 tools/to_pbrt.py NAME >NAME.pbrt && pbrt NAME.pbrt && imgtool convert \
#       --scale 3.14159265 --outfile NAME-pbrt.pfm NAME.exr
#
# reads NAME.obj, its .mtl and NAME.view. Ke, a radiosity, becomes the radiance Ke / pi,
# and pixels times pi are W/m^2. Lamps shine in front alone, other faces reflect on both
# sides. pbrt's axes are left-handed: the picture is mirrored back. It is spectral: faces
# of colours that light one another, as in cornell, differ by some percent.
import math, os, sys

name, samples = sys.argv[1], 64
rows = lambda path: filter(None, (line.split('#')[0].split() for line in open(path)))
points, faces, materials, view = [], {}, {}, {'up': ['0', '1', '0'], 'fov': ['45']}
view.update((key, rest) for key, *rest in rows(name + '.view'))
for key, *rest in rows(name + '.obj'):
    if key == 'mtllib':
        for word, *value in rows(os.path.join(os.path.dirname(name), rest[0])):
            if word == 'newmtl':
                last = materials[value[0]] = {}
            last[word] = [float(x) for x in value] if word in ('Kd', 'Ke') else value
    elif key == 'v':
        points.append(' '.join(rest[:3]))
    elif key == 'usemtl':
        group = faces.setdefault(rest[0], [])
    elif key == 'f':
        at = [int(word.split('/')[0]) for word in rest]
        at = [n - 1 if n > 0 else len(points) + n for n in at]
        group += [(at[0], at[k], at[k + 1]) for k in range(1, len(at) - 1)]
width, height = view['size']
numbers = lambda values: '[' + ' '.join(map(str, values)) + ']'
camera = ' '.join(x for key in ('eye', 'at', 'up') for x in view[key])
print(f'''Scale -1 1 1
LookAt {camera}
Camera "perspective" "float fov" {view['fov'][0]}
Film "rgb" "string filename" "{name}.exr" "bool savefp16" false
    "integer xresolution" {width} "integer yresolution" {height}
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Sampler "independent" "integer pixelsamples" {samples}
Integrator "path" "integer maxdepth" 64
WorldBegin''')
for paint, triangles in faces.items():
    own = materials[paint]
    used = sorted({n for face in triangles for n in face})
    place = {n: k for k, n in enumerate(used)}
    radiance = [x / math.pi for x in own.get('Ke', [0])]
    print('AttributeBegin\nMaterial "diffuse" "rgb reflectance"', numbers(own['Kd']))
    if max(radiance) > 0:
        print('AreaLightSource "diffuse" "rgb L"', numbers(radiance))
    print('Shape "trianglemesh" "integer indices"',
          numbers(place[n] for face in triangles for n in face), '"point3 P"',
          numbers(points[n] for n in used) + '\nAttributeEnd', sep='\n')
