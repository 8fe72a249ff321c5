"""What a loop that was turned and welded does, by films without a mesh and by meshes.

Films of given writhe (curves.py) say it for every rod at once; meshes.py computes flat and
twisted films once more, by a method that shares nothing with it but the physics.
"""
