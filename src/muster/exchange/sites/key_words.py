"""Headings of names and of energy in the languages of those who write tables: lower case, without spaces and marks."""

from __future__ import annotations

_NAMES = """
    title label bezeichnung nom nombre nome naam nazwa nazev název navn namn isim adı имя название назва όνομα ονομα
    اسم الاسم نام שם नाम नम 名称 名稱 名前 이름
"""
_BATTERY = """
    battery batterycapacity batterylevel batterytime batterylife akku akkukapazitat akkukapazität batterie bateria
    batería batteria accu batteri pil batarya акб батарея аккумулятор акумулятор μπαταρία بطارية باتری סוללה 电池 電池
    バッテリー 배터리 energy stateofcharge soc chargelevel
"""
_ENDURANCE = """
    endurance flighttime flyingtime maxflighttime maxendurance runtime operatingtime drivetime hovertime flugzeit
    flugdauer akkulaufzeit laufzeit autonomie autonomia autonomía tempsdevol tiempodevuelo tempodivolo tempodevoo
    vliegtijd czaslotu dobaletu flytid flygtid flyvetid uçuşsüresi времяполета времяполёта часпольоту χρόνοςπτήσης 续航
    续航时间 航続時間 飛行時間 飞行时间 비행시간 체공시간 مدةالطيران مداومتپروازی זמןטיסה
"""
_RANGE = """
    range maxrange flightrange reichweite portée portee alcance raggiodazione bereik zasięg zasieg dosah dolet
    rekkevidde räckvidd rackvidd rækkevidde menzil дальность дальністьпольоту дальність εμβέλεια 航程 航続距離 항속거리
    المدى برد טווח
"""
_TYPES = """
    typ art tipo soort rodzaj druh tip tür тип τύπος نوع סוג प्रकार 类型 類型 種類 種別 유형 종류
"""
_MODELS = """
    modell modele modèle modelo modello модель модел μοντέλο طراز مدل דגם मॉडल 型号 型號 機種 모델 기종
"""


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


NAMES, ENDURANCE, RANGE = _words(_NAMES), _words(_ENDURANCE), _words(_RANGE)
OF_ROBOTS = ("drone", "uav", "uas", "ugv", "rover", "vehicle", "aircraft")
"""Words before headings that say that they are of robots: `Drone ID`."""
TYPES, MODELS = _words(_TYPES), _words(_MODELS)
BATTERY = _words(_BATTERY)
"""Of what may be a time, a length, or neither."""
