from .pages import Pages as Pages
from .server import Service as Service, check_aiohttp as check_aiohttp, serve as serve
from .worker import Worker as Worker
