"""Writes the models and textures of scenes/ajar. Usage: python3 ajar.py"""
import os

import door
import furniture
import paint
import vessels
from mesh import box, slab_with_hole

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'ajar')


def main():
    models, textures = os.path.join(HERE, 'models'), os.path.join(HERE, 'textures')
    os.makedirs(models, exist_ok=True)
    os.makedirs(textures, exist_ok=True)

    def obj(name, mesh): mesh.write_obj(os.path.join(models, name + '.obj'))
    def ply(name, mesh): mesh.write_ply(os.path.join(models, name + '.ply'))

    # a wall of unit thickness: z in [0, 1]; it runs into the neighbouring walls, floor and ceiling
    obj('wall', slab_with_hole((-0.1, -0.1, 0), (4.5, 2.8, 1), (2.975, -0.05), (3.925, 2.075)))
    obj('door', door.leaf())
    obj('door-frame', door.frame())
    ply('door-handle', door.handle())
    ply('hinges', door.hinges())
    obj('floor', box((-0.1, -0.2, -4.5), (4.5, 0, 5.3), grain=2))
    obj('table', furniture.table())
    obj('chair', furniture.chair())
    obj('bookcase', furniture.bookcase())
    for k, mesh in enumerate(furniture.books(4)):
        obj(f'books-{k}', mesh)
    covers, pages = furniture.stack()
    obj('stack-covers', covers)
    obj('stack-pages', pages)
    obj('sofa', furniture.sofa())
    obj('sideboard', furniture.sideboard())
    obj('picture-frame', furniture.picture_frame(0.90, 0.60, 0.045))
    obj('skirting', furniture.skirting(1.0))
    glass, wine, wine_top = vessels.carafe()
    ply('carafe', glass)
    ply('wine', wine)
    ply('wine-top', wine_top)
    ply('pot-handle', vessels.pot_handle())
    ply('twigs', vessels.twigs(12))
    for make in (vessels.tumbler, vessels.teapot, vessels.pot, vessels.bowl, vessels.apple, vessels.stalk, vessels.vase,
                 vessels.candlestick, vessels.candle, vessels.lamp):
        ply(make.__name__, make())
    paint.wood(os.path.join(textures, 'floor.png'), (512, 512), 1, (0.33, 0.20, 0.11), (0.72, 0.52, 0.33), 24,
               planks=10)
    paint.wood(os.path.join(textures, 'oak.png'), (512, 256), 2, (0.52, 0.36, 0.20), (0.86, 0.70, 0.48), 10)
    paint.wood(os.path.join(textures, 'walnut.png'), (384, 192), 3, (0.34, 0.19, 0.11), (0.66, 0.43, 0.26), 8)
    paint.painting(os.path.join(textures, 'lake.png'), 480, 320)
    paint.rug(os.path.join(textures, 'rug.png'), 352, 240)


if __name__ == '__main__':
    main()
